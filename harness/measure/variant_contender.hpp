#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "harness/measure/measurement.hpp"
#include "harness/measure/turns.hpp"
#include "variants/registry.hpp"

namespace carom {

/// A variant on a scene with its tunings, as one of those that take turns. All its runs, the untimed ones
/// among them, are of one simulation. The last step of the first one is checked; the others must end in the
/// same bits after the same work, of which the verdict would be the same.
class VariantContender final : public Contender {
  public:
    explicit VariantContender(Measurement measurement) : measurement_(std::move(measurement)) {}

    /// Runs what a process runs untimed. Returns the seconds that the whole run may be expected to take.
    double prepare();

    int steps() const override { return measurement_.scene.steps; }
    void start() override;
    TurnTime advance(int steps) override;

    /// Ends the last run. A violation is told with the run that has it, if there were several.
    void finish(Turns turns);

    const Measurement& measurement() const { return measurement_; }

  private:
    void end_run();

    Measurement measurement_;
    std::unique_ptr<Simulation> simulation_;
    std::optional<RunInParts> run_;
    int runs_ = 0; ///< that have been started
};

} // namespace carom
