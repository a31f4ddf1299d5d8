#include "harness/collisions/collision_checker.hpp"

#include <cstdint>

#include "harness/collisions/contact_checker.hpp"
#include "harness/collisions/path_checker.hpp"

namespace carom {
namespace {

class ExactSteps final : public CollisionChecker {
  public:
    ExactSteps(const Scene& scene, int substeps) : paths_(scene), substeps_(substeps) {}

    CollisionLog<double>& log() override { return paths_; }

    std::optional<std::string> violation_so_far() const override { return paths_.violation(); }

    std::optional<std::string> step(const std::vector<Disc>& /*before*/,
                                    const std::vector<Disc>& after) override {
        ++steps_;
        return paths_.violation_at(static_cast<double>(steps_) / substeps_, after);
    }

  private:
    PathChecker<double> paths_;
    double substeps_;
    std::int64_t steps_ = 0;
};

} // namespace

std::unique_ptr<CollisionChecker> collision_checker(const Scene& scene, const Variant& variant,
                                                    const Tuning& tuning) {
    if (variant.engine == Engine::event_driven) {
        return std::make_unique<ExactSteps>(scene, tuning.substeps);
    }
    if (variant.policies.impact == Impact::at_contact) {
        return std::make_unique<ContactChecker>(scene, variant.policies, tuning);
    }
    return nullptr;
}

} // namespace carom
