#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "harness/doctor/doctor.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

using Json = nlohmann::ordered_json;

/// Lines of a label and a text, which goes on under itself where the line is full.
class Screen {
  public:
    void line(const std::string& label, const std::string& text) {
        constexpr std::size_t indent = 12;
        std::string begun = label;
        begun.resize(std::max(label.size() + 1, indent), ' ');
        text_ += wrapped(begun + text, indent);
    }

    const std::string& text() const { return text_; }

  private:
    std::string text_;
};

std::string number(const char* format, double value) {
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), format, value);
    return text.data();
}

std::string bytes(const Json& value) {
    double amount = value.get<double>();
    const char* unit = "B";
    for (const char* next : {"KiB", "MiB", "GiB", "TiB"}) {
        if (amount < 1024) {
            break;
        }
        amount /= 1024;
        unit = next;
    }
    return number("%.4g ", amount) + unit;
}

std::string plural(const Json& count, const std::string& one) {
    return count.is_null() ? one + "s not told" : counted(count.get<int>(), one);
}

/// A text, or on and off for a yes or no; `unknown` for null.
std::string word(const Json& value, const char* unknown) {
    if (value.is_boolean()) {
        return value.get<bool>() ? "on" : "off";
    }
    return value.is_null() ? unknown : value.get<std::string>();
}

std::string list(const Json& texts) {
    std::string joined;
    for (const Json& text : texts) {
        joined += (joined.empty() ? "" : ", ") + text.get<std::string>();
    }
    return joined;
}

void show_machine(const Json& machine, Screen& screen) {
    screen.line("host", machine["host"].get<std::string>() + ", " +
                            machine["operating_system"].get<std::string>() +
                            (machine["virtualised"] ? ", a virtual machine" : ""));
    const Json& available = machine["memory_available_bytes"];
    screen.line("memory", bytes(machine["memory_bytes"]) +
                              (available.is_null() ? "" : ", " + bytes(available) + " available"));
}

void show_cpu(const Json& findings, Screen& screen) {
    const Json& topology = findings["topology"];
    screen.line("CPU", findings["machine"]["cpu_model"].get<std::string>() + ": " +
                           plural(topology["packages"], "package") + ", " +
                           plural(topology["cores"], "core") + ", " +
                           plural(topology["hardware_threads"], "hardware thread") + ", SMT " +
                           word(topology["smt"], "not told"));
    std::string caches;
    for (const Json& cache : topology["caches"]) {
        caches += std::to_string(cache["count"].get<int>()) + " " + cache["name"].get<std::string>() +
                  " of " + bytes(cache["bytes"]) + ", ";
    }
    const std::string source = topology["source"].get<std::string>();
    const std::string untold = "not told by " + source + "; remedy: build with libhwloc-dev";
    screen.line("caches", caches.empty() ? untold : caches + "told by " + source);
    screen.line("NUMA", topology["numa_nodes"].is_null() ? untold : plural(topology["numa_nodes"], "node"));
    const Json& frequency = findings["frequency"];
    const bool host_decides = frequency["governor"].is_null() && findings["machine"]["virtualised"];
    screen.line("frequency", "governor " + word(frequency["governor"], "not told") + ", turbo " +
                                 word(frequency["turbo"], "not told") +
                                 (host_decides ? "; the host of this virtual machine decides" : ""));
    const Json& affinity = findings["affinity"];
    const bool is_part = affinity["affinity_count"] < affinity["hardware_threads"];
    screen.line("affinity",
                plural(affinity["affinity_count"], "CPU") + ": " + affinity["affinity"].get<std::string>() +
                    (is_part ? ", of " + plural(affinity["hardware_threads"], "hardware thread") : ""));
    const Json& quota = affinity["cpu_quota"];
    if (!quota.is_null()) {
        screen.line("CPU quota",
                    "time of " + number("%.4g", quota) + (quota == 1 ? " processor" : " processors") +
                        " in all (cgroup); on more threads than that each is halted for a part of "
                        "the time");
    }
    screen.line("threads", "Carom takes " + plural(affinity["threads_by_default"], "thread") +
                               " by default, on " +
                               plural(affinity["usable_processors"], "usable processor"));
}

void show_openmp(const Json& openmp, Screen& screen) {
    screen.line("OpenMP", openmp["runtime"].get<std::string>() + ", version " +
                              std::to_string(openmp["version"].get<int>()) + ", " +
                              plural(openmp["max_threads"], "thread") + " by default, dynamic " +
                              word(openmp["dynamic"], "") + ", bind " +
                              openmp["proc_bind"].get<std::string>() + ", " +
                              plural(openmp["places"], "place"));
    std::string environment;
    for (const auto& [name, value] : openmp["environment"].items()) {
        environment += " " + name + "=" + value.get<std::string>();
    }
    screen.line("",
                environment.empty() ? "no OMP_*, GOMP_* or KMP_* variable is set" : environment.substr(1));
}

/// The events that are missing for one reason together, in the order in which the reasons come up.
void show_missing(const Json& source, Screen& screen) {
    const std::string cannot_count = source["source"].get<std::string>() + " cannot count ";
    std::vector<std::pair<std::string, std::string>> reasons;
    for (const Json& missing : source["missing"]) {
        const std::string why =
            missing["reason"].get<std::string>() + "; remedy: " + missing["remedy"].get<std::string>();
        const auto same = std::ranges::find(reasons, why, &std::pair<std::string, std::string>::first);
        if (same == reasons.end()) {
            reasons.emplace_back(why, cannot_count + missing["event"].get<std::string>());
        } else {
            same->second += ", " + missing["event"].get<std::string>();
        }
    }
    for (auto& [why, line] : reasons) {
        screen.line("", line.append(": ").append(why));
    }
}

void show_counters(const Json& findings, Screen& screen) {
    const Json& perf = findings["perf_events"];
    screen.line("counters", "PAPI " + perf["papi"].get<std::string>() + "; perf_event_paranoid " +
                                (perf["paranoid"].is_null() ? "not told" : perf["paranoid"].dump()) +
                                (perf["pmu"] ? "" : "; no performance-monitoring unit (PMU)"));
    for (const Json& source : findings["counters"]) {
        const std::string name = source["source"].get<std::string>();
        if (!source["events"].empty()) {
            const bool by_papi = name.starts_with("papi");
            screen.line("", name + " counts " +
                                (by_papi ? list(source["events"]) + ", in " + plural(source["runs"], "run")
                                         : plural(source["events"].size(), "figure")));
        }
        show_missing(source, screen);
    }
}

/// A program's version, or how to get it.
void show_tool(const std::string& name, const Json& version, const std::string& package, Screen& screen) {
    screen.line(name, word(version, ("not on PATH; remedy: install the package " + package).c_str()));
}

void show_software(const Json& findings, Screen& screen) {
    const Json& program = findings["program"];
    screen.line("program", "built by " + program["compiler"].get<std::string>() + ", " +
                               program["build_type"].get<std::string>() + ", commit " +
                               word(program["commit"], "not known").substr(0, 12) +
                               (program["dirty"] == true ? " with changes" : ""));
    const Json& tools = findings["tools"];
    show_tool("g++", tools["g++"], "g++", screen);
    show_tool("clang++", tools["clang++"], "clang", screen);
    show_tool("valgrind", tools["valgrind"], "valgrind", screen);
    show_tool("perf", tools["perf"], "linux-perf", screen);
    const Json& slurm = findings["slurm"];
    screen.line("Slurm", word(slurm["version"], "srun not on PATH") +
                             (slurm["job"].is_null()
                                  ? ", not inside a job"
                                  : ", inside job " + slurm["job"].value("SLURM_JOB_ID", "not named")));
}

void show_noise(const Json& noise, Screen& screen) {
    screen.line(
        "noise",
        std::to_string(noise["spins"].get<int>()) + " equal spins of " +
            number("%.3g ms", 1e3 * noise["median_seconds"].get<double>()) + ": 95 % within " +
            number("%.3f", noise["p95_over_median"]) + ", the slowest " +
            number("%.2f", noise["max_over_median"]) + " times the median; steal time " +
            (noise["steal"].is_null() ? "not told" : number("%.1f %%", 100 * noise["steal"].get<double>())));
}

} // namespace

std::string doctor_text(const Json& findings) {
    Screen screen;
    show_machine(findings["machine"], screen);
    show_cpu(findings, screen);
    show_openmp(findings["openmp"], screen);
    show_counters(findings, screen);
    show_software(findings, screen);
    show_noise(findings["noise"], screen);
    return screen.text();
}

} // namespace carom
