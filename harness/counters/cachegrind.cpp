#include "harness/counters/cachegrind.hpp"

#include <algorithm>
#include <array>
#include <csignal>
#include <cstddef>
#include <iterator>
#include <optional>
#include <sstream>
#include <utility>

#include "harness/processes/process.hpp"
#include "harness/scenes/scene_file.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/input_file.hpp"
#include "harness/support/output_file.hpp"
#include "harness/support/temporary_folder.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

/// Names of cachegrind and of a record. The last ones are sizes of caches, in bytes.
constexpr std::array<std::pair<const char*, const char*>, 16> names{{{"Ir", "instructions"},
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
                                                                     {"Bim", "indirect_branch_misses"},
                                                                     {"I1", "l1_instruction_cache_bytes"},
                                                                     {"D1", "l1_data_cache_bytes"},
                                                                     {"LL", "llc_bytes"}}};
constexpr std::size_t size_count = 3;

void require_success(const nlohmann::ordered_json& end) {
    const int signal = end["signal"];
    const int exit_code = end["exit_code"];
    if (end["not_started"] != "") {
        throw CounterError(no_valgrind().reason, no_valgrind().remedy);
    }
    if (end["unknown"] != "") {
        throw CounterError("how cachegrind ended is not known", "run it again");
    }
    if (signal == SIGILL) {
        throw CounterError(
            "valgrind " + valgrind_version() + " does not know an instruction of this program (SIGILL)",
            "a build for the compiler's default architecture (CAROM_ARCH empty), or a newer valgrind");
    }
    if (signal != 0) {
        throw CounterError("cachegrind was killed by signal " + std::to_string(signal), "run it again");
    }
    if (exit_code != 0) {
        const std::string printed = end["output_end"];
        const std::string error = end["error_end"];
        throw CounterError("cachegrind ended with exit code " + std::to_string(exit_code) + ": " +
                               (error.empty() ? last_line(printed) : error),
                           "`valgrind --tool=cachegrind carom run` shows more");
    }
}

/// A whole run under cachegrind, which has begun.
class SimulatedRun {
  public:
    SimulatedRun(const Scene& scene, std::string_view variant, const Tuning& tuning,
                 const std::filesystem::path& program)
        : process_(
              {.words =
                   {"valgrind",           "--quiet",
                    "--tool=cachegrind",  "--cache-sim=yes",
                    "--branch-sim=yes",   "--cachegrind-out-file=" + (folder_ / "cachegrind.out"),
                    program.string(),     "run",
                    folder_ / "scene.in", "1",
                    "--variant",          std::string(variant),
                    "--find-chunk",       std::to_string(tuning.find_chunk),
                    "--resolve-chunk",    std::to_string(tuning.resolve_chunk),
                    "--substeps",         std::to_string(tuning.substeps),
                    "--sweep-limit",      std::to_string(tuning.sweep_limit),
                    "--tolerance",        tuning.tolerance == Tolerance::relative ? "relative" : "published"},
               .most_seconds = without_limit},
              nullptr) {
        write_text(folder_ / "scene.in", scene_text(scene));
        process_.begin();
    }

    /// What cachegrind has counted, once the run has ended. Throws CounterError.
    std::map<std::string, double> counts() {
        process_.advance(without_limit);
        require_success(process_.facts());
        return parse_cachegrind(read_file(folder_ / "cachegrind.out"));
    }

  private:
    static constexpr double without_limit = 1e9;
    TemporaryFolder folder_{"carom-"};
    Process process_;
};

CounterValue row(const std::string& name, std::optional<double> value, const std::string& reason = "",
                 const std::string& remedy = "") {
    return {name, {}, value, "cachegrind", reason, remedy};
}

} // namespace

std::vector<std::string> simulated_counts() {
    std::vector<std::string> counts;
    for (std::size_t k = 0; k + size_count < names.size(); ++k) {
        counts.emplace_back(names[k].second);
    }
    return counts;
}

std::map<std::string, double> parse_cachegrind(const std::string& text) {
    std::map<std::string, std::string> found;
    std::vector<std::string> events;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string key;
        std::string name;
        words >> key;
        if (key == "desc:" && words >> name >> key && key == "cache:") {
            words >> found[name];
        } else if (key == "events:") {
            events.assign(std::istream_iterator<std::string>(words), {});
        } else if (key == "summary:") {
            for (const std::string& event : events) {
                words >> found[event];
            }
        }
    }
    std::map<std::string, double> values;
    for (const auto& [name, counter] : names) {
        const auto value = parse_number<double>(found[name]);
        if (!value) {
            throw CounterError("cachegrind's output: found '" + found[name] + "' for " + name +
                                   ", expected a number",
                               "a valgrind whose output carom reads, such as 3.19");
        }
        values[counter] = *value;
    }
    return values;
}

std::vector<CounterValue> simulate_counters(const Scene& scene, std::string_view variant,
                                            const Tuning& tuning, int units,
                                            const std::filesystem::path& program) {
    const auto carom = program.empty() ? std::filesystem::read_symlink("/proc/self/exe") : program;
    std::vector<CounterValue> rows;
    Scene beginning = scene;
    beginning.steps = 0;
    Scene shortened = scene;
    shortened.steps = std::min(units, scene.steps);
    try {
        // At once: counts do not depend on what else runs, and valgrind takes long to start.
        SimulatedRun none(beginning, variant, tuning, carom);
        auto values = SimulatedRun(shortened, variant, tuning, carom).counts();
        const auto before = none.counts();
        for (const std::string& name : simulated_counts()) {
            values[name] -= before.at(name);
        }
        for (const auto& [cachegrind, name] : names) {
            rows.push_back(row(name, values[name]));
        }
        rows.push_back(row("steps", static_cast<double>(shortened.steps) * tuning.substeps));
    } catch (const CounterError& error) {
        for (const std::string& name : simulated_counts()) {
            rows.push_back(row(name, {}, error.what(), error.remedy));
        }
    }
    return rows;
}

std::string valgrind_version() {
    const std::string line = version_line("valgrind");
    constexpr std::string_view prefix = "valgrind-";
    return line.starts_with(prefix) ? line.substr(prefix.size()) : "";
}

Explanation no_valgrind() { return {"valgrind is not on PATH", "install the package valgrind"}; }

} // namespace carom
