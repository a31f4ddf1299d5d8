#include "harness/machine/limits.hpp"
#include "harness/support/format.hpp"

namespace carom {
namespace {

using Json = nlohmann::ordered_json;

Json rate_json(const Rate& rate) {
    return {{"best", rate.best}, {"median", rate.median}, {"repetitions", rate.repetitions}};
}

std::string rate_text(const Rate& rate, const char* unit) {
    return format("%3d %-7s %9.4g %s (median %.4g of %d)\n", rate.threads,
                  rate.threads == 1 ? "thread" : "threads", 1e-9 * rate.best, unit, 1e-9 * rate.median,
                  rate.repetitions);
}

} // namespace

Json limits_json(const Limits& limits) {
    Json json{{"copy", Json::array()}, {"arithmetic", Json::array()}};
    for (const auto& [set, rate] : limits.copy) {
        json["copy"].push_back({{"level", set.level},
                                {"working_set_bytes", set.bytes},
                                {"threads", rate.threads},
                                {"bytes_per_second", rate_json(rate)}});
    }
    for (const auto& [lanes, rate] : limits.arithmetic) {
        json["arithmetic"].push_back(
            {{"lanes", lanes}, {"threads", rate.threads}, {"operations_per_second", rate_json(rate)}});
    }
    return json;
}

std::string limits_text(const Limits& limits) {
    std::string text = "best rates\n";
    for (const auto& [set, rate] : limits.copy) {
        text += format("copy within %7lld KiB, %-6s ", static_cast<long long>(set.bytes / 1024),
                       set.level.c_str()) +
                rate_text(rate, "GB/s");
    }
    for (const auto& [lanes, rate] : limits.arithmetic) {
        text += format("x * a + b, %d at once           ", lanes) + rate_text(rate, "Gflop/s");
    }
    return text;
}

} // namespace carom
