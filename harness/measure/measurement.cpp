#include "harness/measure/measurement.hpp"

#include <cstring>
#include <utility>

namespace carom {
namespace {

bool same_bits(const std::vector<Disc>& one, const std::vector<Disc>& two) {
    return one.size() == two.size() && std::memcmp(one.data(), two.data(), one.size() * sizeof(Disc)) == 0;
}

} // namespace

void Measurement::add(Run run) {
    if (!violation) {
        violation = run.violation;
    }
    if (!repetitions.empty()) {
        Run& before = repetitions.back();
        if (!violation && !same_bits(before.discs, run.discs)) {
            violation = "the final state differs from the one of the run before";
        } else if (!violation && before.work != run.work) {
            violation = "the work differs from that of the run before, and the final state does not";
        }
        std::vector<Disc>().swap(before.discs);
    }
    repetitions.push_back(std::move(run));
}

Run Measurement::run_alone(CheckScope checked, Stopwatch stopwatch) const {
    if (checked == CheckScope::every_step) {
        return checked_run(scene, variant, tuning);
    }
    const auto simulation = variant.simulate(scene, tuning);
    return run_scene(scene, *simulation, tuning, {checked, variant}, nullptr, std::move(stopwatch));
}

} // namespace carom
