#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "harness/measure/measurement.hpp"
#include "harness/measure/turns.hpp"
#include "variants/registry.hpp"

namespace carom {

/// A variant on a scene with its tunings, as one of those that take turns.
class VariantContender final : public Contender {
  public:
    explicit VariantContender(Measurement measurement) : measurement_(std::move(measurement)) {}

    /// Runs what a process runs untimed. Returns the seconds that the whole run may be expected to take.
    double prepare();

    int steps() const override { return measurement_.scene.steps; }
    double advance(int steps) override;

    /// Ends the run, whose turns took so many seconds each.
    void finish(Turns turns);

    const Measurement& measurement() const { return measurement_; }

  private:
    Measurement measurement_;
    std::unique_ptr<Simulation> simulation_;
    std::optional<RunInParts> run_;
};

} // namespace carom
