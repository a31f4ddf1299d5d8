#include "harness/counters/cachegrind.hpp"

#include <algorithm>
#include <csignal>
#include <string>
#include <utility>

#include "harness/counters/cachegrind_output.hpp"
#include "harness/processes/process.hpp"
#include "harness/scenes/scene_file.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/input_file.hpp"
#include "harness/support/output_file.hpp"
#include "harness/support/temporary_folder.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

/// Why nothing can be simulated, and what to do about it.
class Obstacle : public CounterError {
  public:
    explicit Obstacle(const Explanation& why) : CounterError(why.reason), why_(why) {}
    const Explanation& why() const { return why_; }

  private:
    Explanation why_;
};

void require_success(const ProcessEnd& end) {
    if (!end.not_started.empty()) {
        throw Obstacle(no_valgrind());
    }
    if (!end.unknown.empty()) {
        throw Obstacle({"how cachegrind ended is not known", "run it again"});
    }
    if (end.signal == SIGILL) {
        throw Obstacle(
            {"valgrind " + valgrind_version() + " does not know an instruction of this program (SIGILL)",
             "a build for the compiler's default architecture (CAROM_ARCH empty), or a newer valgrind"});
    }
    if (end.signal != 0) {
        throw Obstacle({"cachegrind was killed by signal " + std::to_string(end.signal), "run it again"});
    }
    if (end.exit_code != 0) {
        throw Obstacle({"cachegrind ended with exit code " + std::to_string(end.exit_code) + ": " +
                            last_line(end.output.end + end.error.end),
                        "`valgrind --tool=cachegrind carom run` shows more"});
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
              KeptBy::subreaper) {
        write_text(folder_ / "scene.in", scene_text(scene));
        process_.begin();
    }

    /// What cachegrind has counted, once the run has ended. Throws Obstacle.
    std::map<std::string_view, double> counts() {
        process_.advance(without_limit);
        require_success(process_.end());
        try {
            return parse_cachegrind(read_file(folder_ / "cachegrind.out"));
        } catch (const CounterError& error) {
            throw Obstacle({error.what(), "a valgrind whose output carom reads, such as 3.19"});
        }
    }

  private:
    static constexpr double without_limit = 1e9;
    TemporaryFolder folder_{"carom-"};
    Process process_;
};

CounterValue row(std::string_view name, std::optional<double> value, const Explanation& why = {}) {
    return {std::string(name), {}, value, "cachegrind", why.reason, why.remedy};
}

} // namespace

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
        auto with_steps = SimulatedRun(shortened, variant, tuning, carom).counts();
        auto without_steps = none.counts();
        for (const SimulatedName& name : simulated_counts()) {
            rows.push_back(row(name.counter, with_steps[name.counter] - without_steps[name.counter]));
        }
        for (const SimulatedName& name : simulated_sizes()) {
            rows.push_back(row(name.counter, with_steps[name.counter]));
        }
        rows.push_back(row("steps", static_cast<double>(shortened.steps) * tuning.substeps));
    } catch (const Obstacle& obstacle) {
        for (const SimulatedName& name : simulated_counts()) {
            rows.push_back(row(name.counter, {}, obstacle.why()));
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
