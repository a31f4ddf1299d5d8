#include "harness/records/profile_json.hpp"

#include <string>

#include "harness/measure/timeline.hpp"
#include "harness/support/json.hpp"

namespace carom {
namespace {

using Json = nlohmann::ordered_json;

Json counter_json(const CounterValue& counter) {
    return {{"name", counter.name},
            {"thread", or_null(counter.thread)},
            {"value", or_null(counter.value)},
            {"source", counter.source},
            {"reason", text_or_null(counter.reason)},
            {"remedy", text_or_null(counter.remedy)}};
}

} // namespace

Json profile_json(const Profile& profile) {
    Json phases = Json::array();
    Json threads = Json::array();
    for (const Phase phase : all_phases) {
        const PhaseTime& time = profile.profiler.phase_time(phase);
        phases.push_back({{"phase", word(phase)},
                          {"wall_seconds", time.wall_seconds},
                          {"serial_seconds", time.serial_seconds}});
        for (int thread = 0; thread < profile.profiler.threads(); ++thread) {
            const ThreadWork& work = profile.profiler.work(phase, thread);
            threads.push_back({{"phase", word(phase)},
                               {"thread", thread},
                               {"busy_seconds", work.busy_seconds},
                               {"waiting_seconds", work.waiting_seconds},
                               {"iterations", work.iterations},
                               {"chunks", work.chunks},
                               {"loops", work.loops}});
        }
    }
    Json counters = Json::array();
    for (const CounterValue& counter : profile.counters) {
        counters.push_back(counter_json(counter));
    }
    return {{"wall_seconds", profile.wall_seconds},
            {"cost", profile.cost},
            {"phases", phases},
            {"threads", threads},
            {"counters", counters}};
}

} // namespace carom
