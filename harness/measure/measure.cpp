#include "harness/measure/measure.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "harness/support/format.hpp"
#include "harness/verify/checker.hpp"

namespace carom {
namespace {

std::string at_step(int step, int substep, int substeps, const std::string& what) {
    std::string where = "step " + std::to_string(step);
    if (substeps > 1) {
        where += " substep " + std::to_string(substep) + " of " + std::to_string(substeps);
    }
    return where + ": " + what;
}

std::string unsettled(const Checker& checker, const std::vector<Disc>& discs, int sweep_limit,
                      Engine engine) {
    if (engine == Engine::event_driven) {
        return "the collisions of one instant do not come to an end: a disc is wedged";
    }
    return "the resolve did not end within " + std::to_string(sweep_limit) + " sweeps: " +
           checker.colliding(discs).value_or("something is colliding below the checker's tolerance");
}

} // namespace

RunInParts::RunInParts(const Scene& scene, Simulation& simulation, const Tuning& tuning, const Check& check,
                       OnStep on_step, Stopwatch stopwatch)
    : scene_(scene), simulation_(simulation), tuning_(tuning), check_(check),
      checker_(scene.side, scene.radius, 1.0 / tuning.substeps, tuning.tolerance, rounding_of(check.policies),
               check.policies.impact, check.engine),
      on_step_(std::move(on_step)), stopwatch_(std::move(stopwatch)) {}

TurnTime RunInParts::advance(int steps) {
    const double before = stopwatch_.wall_seconds();
    const int end = done_ + std::min(steps, scene_.steps - done_);
    std::optional<double> returning;
    stopwatch_.start();
    if (end - done_ > 1 && !run_.violation) {
        go_on_to(done_ + 1);
        returning = stopwatch_.running_wall_seconds() - before;
    }
    go_on_to(end);
    stopwatch_.stop();
    return {.steps = steps, .seconds = stopwatch_.wall_seconds() - before, .returning_seconds = returning};
}

void RunInParts::go_on_to(int end) {
    while (done_ < end && !run_.violation) {
        const int unseen = unseen_until(end);
        if (unseen > 1) {
            advance_unseen(unseen);
        } else {
            advance_by_one();
        }
    }
}

/// Units of time from here on at whose ends nobody looks.
int RunInParts::unseen_until(int end) const {
    if (on_step_ || check_.scope == CheckScope::every_step) {
        return 0;
    }
    return std::min(end, check_.scope == CheckScope::last_step ? scene_.steps - 1 : scene_.steps) - done_;
}

void RunInParts::advance_unseen(int units) {
    const auto [work, count] = simulation_.steps(std::int64_t{units} * tuning_.substeps);
    run_.work += work;
    if (!work.settled) {
        const int before_last = static_cast<int>(count - 1);
        stopwatch_.stop();
        run_.violation = at_step(done_ + before_last / tuning_.substeps + 1,
                                 before_last % tuning_.substeps + 1, tuning_.substeps, violation_unsettled());
        stopwatch_.start();
    }
    done_ += units;
}

void RunInParts::advance_by_one() {
    ++done_;
    for (int substep = 1; substep <= tuning_.substeps && !run_.violation; ++substep) {
        step(substep);
    }
    if (on_step_) {
        stopwatch_.stop();
        on_step_(done_, simulation_);
        stopwatch_.start();
    }
}

void RunInParts::step(int substep) {
    const bool last = done_ == scene_.steps && substep == tuning_.substeps;
    const bool checked =
        check_.scope == CheckScope::every_step || (check_.scope == CheckScope::last_step && last);
    if (checked) {
        stopwatch_.stop();
        before_ = simulation_.discs();
        stopwatch_.start();
    }
    const Tally tally = simulation_.step();
    run_.work += tally;
    if (checked || !tally.settled) {
        stopwatch_.stop();
        const auto violation =
            tally.settled ? violation_after(simulation_.discs()) : std::optional(violation_unsettled());
        if (violation) {
            run_.violation = at_step(done_, substep, tuning_.substeps, *violation);
        }
        stopwatch_.start();
    }
}

std::optional<std::string> RunInParts::violation_after(const std::vector<Disc>& after) const {
    if (check_.collisions != nullptr) {
        return check_.collisions->step(before_, after);
    }
    const std::string end = check_.right_ends != nullptr ? state_hash(after) : "";
    if (check_.right_ends != nullptr && check_.right_ends->contains(end)) {
        return std::nullopt;
    }
    auto violation = checker_.step(before_, after);
    if (check_.right_ends != nullptr && !violation) {
        check_.right_ends->insert(end);
    }
    return violation;
}

/// What is wrong with a step that did not end, if it is not that alone.
std::string RunInParts::violation_unsettled() const {
    const auto told = check_.collisions != nullptr ? check_.collisions->violation_so_far() : std::nullopt;
    return told ? *told : unsettled(checker_, simulation_.discs(), tuning_.sweep_limit, check_.engine);
}

Run RunInParts::finish() {
    run_.steps_seconds = stopwatch_.wall_seconds();
    run_.cpu_seconds = stopwatch_.cpu_seconds();
    run_.discs = simulation_.discs();
    return std::move(run_);
}

Run run_scene(const Scene& scene, Simulation& simulation, const Tuning& tuning, const Check& check,
              const OnStep& on_step, Stopwatch stopwatch) {
    RunInParts run(scene, simulation, tuning, check, on_step, std::move(stopwatch));
    run.advance(scene.steps);
    return run.finish();
}

Run checked_run(const Scene& scene, const Variant& variant, const Tuning& tuning, const OnStep& on_step) {
    const auto collisions = collision_checker(scene, variant, tuning);
    const auto simulation =
        collisions ? variant.simulate_logged(scene, tuning, *collisions) : variant.simulate(scene, tuning);
    return run_scene(scene, *simulation, tuning, {CheckScope::every_step, variant, collisions.get()},
                     on_step);
}

std::string state_hash(const std::vector<Disc>& discs) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const Disc& disc : discs) {
        for (const double value : {disc.x, disc.y, disc.vx, disc.vy}) {
            const auto bits = std::bit_cast<std::uint64_t>(value);
            for (int byte = 0; byte < 64; byte += 8) {
                hash = (hash ^ ((bits >> byte) & 0xff)) * 0x100000001b3;
            }
        }
    }
    return format("%016llx", static_cast<unsigned long long>(hash));
}

} // namespace carom
