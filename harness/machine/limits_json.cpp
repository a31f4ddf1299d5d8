#include "harness/machine/limits.hpp"
#include "harness/machine/threads.hpp"
#include "harness/support/format.hpp"

namespace carom {
namespace {

using Json = nlohmann::ordered_json;

Json rate_json(const Rate& rate) {
    return {{"best", rate.best}, {"median", rate.median}, {"repetitions", rate.repetitions}};
}

std::string rate_text(const Json& rate, const char* unit) {
    return format("%9.4g %s (median %.4g of %d)", 1e-9 * rate["best"].get<double>(), unit,
                  1e-9 * rate["median"].get<double>(), rate["repetitions"].get<int>());
}

std::string threads_text(const Json& row) {
    const int threads = row["threads"].get<int>();
    return format("%3d %-7s", threads, threads == 1 ? "thread" : "threads");
}

} // namespace

Json limits_json(int threads, double seconds, std::int64_t most_bytes) {
    require_threads(threads);
    const Topology topology = read_topology();
    Json copy = Json::array();
    Json arithmetic = Json::array();
    for (int count = 1; count <= threads; ++count) {
        for (const WorkingSet& set : working_sets(topology, most_bytes, count)) {
            copy.push_back({{"level", set.level},
                            {"working_set_bytes", set.bytes},
                            {"threads", count},
                            {"bytes_per_second", rate_json(measure_copy(set, count, seconds))}});
        }
        for (const Arithmetic kind : {Arithmetic::scalar, Arithmetic::vector}) {
            arithmetic.push_back(
                {{"lanes", lanes(kind)},
                 {"threads", count},
                 {"operations_per_second", rate_json(measure_arithmetic(kind, count, seconds))}});
        }
    }
    return {{"copy", copy}, {"arithmetic", arithmetic}};
}

std::string limits_text(const Json& limits) {
    std::string text = "best rates\n";
    for (const Json& row : limits["copy"]) {
        text +=
            format("copy within %7lld KiB, %-6s %s %s\n", row["working_set_bytes"].get<long long>() / 1024,
                   row["level"].get<std::string>().c_str(), threads_text(row).c_str(),
                   rate_text(row["bytes_per_second"], "GB/s").c_str());
    }
    for (const Json& row : limits["arithmetic"]) {
        text += format("x * a + b, %d at once           %s %s\n", row["lanes"].get<int>(),
                       threads_text(row).c_str(), rate_text(row["operations_per_second"], "Gflop/s").c_str());
    }
    return text;
}

} // namespace carom
