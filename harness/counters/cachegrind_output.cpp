#include "harness/counters/cachegrind_output.hpp"

#include <array>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "harness/counters/event_set.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

constexpr std::array<SimulatedName, 13> counts{{{"Ir", "instructions"},
                                                {"I1mr", "l1_instruction_misses"},
                                                {"ILmr", "llc_instruction_misses"},
                                                {"Dr", "data_reads"},
                                                {"D1mr", "l1_read_misses"},
                                                {"DLmr", "llc_read_misses"},
                                                {"Dw", "data_writes"},
                                                {"D1mw", "l1_write_misses"},
                                                {"DLmw", "llc_write_misses"},
                                                {"Bc", "conditional_branches"},
                                                {"Bcm", "conditional_branch_misses"},
                                                {"Bi", "indirect_branches"},
                                                {"Bim", "indirect_branch_misses"}}};

constexpr std::array<SimulatedName, 3> sizes{
    {{"I1", "l1_instruction_cache_bytes"}, {"D1", "l1_data_cache_bytes"}, {"LL", "llc_bytes"}}};

/// The fields of the first line that starts with `key`.
std::vector<std::string> fields_of(std::string_view text, const std::string& key) {
    std::istringstream lines{std::string(text)};
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with(key)) {
            std::istringstream rest(line.substr(key.size()));
            std::vector<std::string> fields;
            for (std::string field; rest >> field;) {
                fields.push_back(field);
            }
            return fields;
        }
    }
    throw CounterError("cachegrind's output: found no line `" + key + "`");
}

double number(const std::string& text, const std::string& line) {
    const auto value = parse_number<double>(text);
    if (!value) {
        throw CounterError("cachegrind's output: found '" + text + "' in its line `" + line +
                           "`, expected a number");
    }
    return *value;
}

} // namespace

std::span<const SimulatedName> simulated_counts() { return counts; }

std::span<const SimulatedName> simulated_sizes() { return sizes; }

std::map<std::string_view, double> parse_cachegrind(std::string_view text) {
    const auto events = fields_of(text, "events:");
    const auto totals = fields_of(text, "summary:");
    if (events.size() != totals.size()) {
        throw CounterError("cachegrind's output: found " + std::to_string(totals.size()) +
                           " totals in its line `summary:`, expected " + std::to_string(events.size()));
    }
    std::map<std::string, double> found;
    for (std::size_t i = 0; i < events.size(); ++i) {
        found[events[i]] = number(totals[i], "summary:");
    }
    std::map<std::string_view, double> values;
    for (const SimulatedName& name : counts) {
        const auto total = found.find(std::string(name.cachegrind));
        if (total == found.end()) {
            throw CounterError("cachegrind's output: found no event " + std::string(name.cachegrind));
        }
        values[name.counter] = total->second;
    }
    for (const SimulatedName& name : sizes) {
        const std::string key = "desc: " + std::string(name.cachegrind) + " cache:";
        const auto fields = fields_of(text, key);
        values[name.counter] = number(fields.empty() ? "" : fields.front(), key);
    }
    return values;
}

} // namespace carom
