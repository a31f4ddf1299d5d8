#include "harness/measure/measure.hpp"

#include <bit>
#include <cstdio>

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

std::string unsettled(const Checker& checker, const std::vector<Disc>& discs, int sweep_limit) {
    return "the resolve did not end within " + std::to_string(sweep_limit) + " sweeps: " +
           checker.colliding(discs).value_or("something is colliding below the checker's tolerance");
}

} // namespace

Run run_scene(const Scene& scene, Simulation& simulation, const Tuning& tuning, const Check& check,
              const OnStep& on_step, Stopwatch stopwatch) {
    Run run;
    const Checker checker(scene.side, scene.radius, 1.0 / tuning.substeps, tuning.tolerance, check.rounding);
    std::vector<Disc> before;
    stopwatch.start();
    for (int step = 1; step <= scene.steps && !run.violation; ++step) {
        for (int substep = 1; substep <= tuning.substeps && !run.violation; ++substep) {
            const bool last = step == scene.steps && substep == tuning.substeps;
            const bool checked =
                check.scope == CheckScope::every_step || (check.scope == CheckScope::last_step && last);
            if (checked) {
                stopwatch.stop();
                before = simulation.discs();
                stopwatch.start();
            }
            const Tally tally = simulation.step();
            run.work += tally;
            if (checked || !tally.settled) {
                stopwatch.stop();
                const auto violation = tally.settled
                                           ? checker.step(before, simulation.discs())
                                           : unsettled(checker, simulation.discs(), tuning.sweep_limit);
                if (violation) {
                    run.violation = at_step(step, substep, tuning.substeps, *violation);
                }
                stopwatch.start();
            }
        }
        if (on_step) {
            stopwatch.stop();
            on_step(step, simulation.discs());
            stopwatch.start();
        }
    }
    stopwatch.stop();
    run.steps_seconds = stopwatch.wall_seconds();
    run.cpu_seconds = stopwatch.cpu_seconds();
    run.discs = simulation.discs();
    return run;
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
    std::string text(16, '0');
    std::snprintf(text.data(), text.size() + 1, "%016llx", static_cast<unsigned long long>(hash));
    return text;
}

} // namespace carom
