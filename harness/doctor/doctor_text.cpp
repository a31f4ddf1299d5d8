#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <CLI/StringTools.hpp>

#include "harness/doctor/findings.hpp"
#include "harness/machine/provenance.hpp"
#include "harness/support/format.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

using Json = nlohmann::ordered_json;

/// A label and a text, which goes on under itself where the line is full.
std::string line(std::string label, const std::string& text) {
    constexpr std::size_t indent = 12;
    label.resize(std::max(label.size() + 1, indent), ' ');
    return wrapped(label + text, indent);
}

std::string bytes_text(std::int64_t bytes) {
    auto amount = static_cast<double>(bytes);
    const char* unit = "B";
    for (const char* next : {"KiB", "MiB", "GiB", "TiB"}) {
        if (amount < 1024) {
            break;
        }
        amount /= 1024;
        unit = next;
    }
    return format("%.4g %s", amount, unit);
}

std::string text_of(const Json& text) { return text.is_null() ? "not told" : text.get<std::string>(); }

std::string plural(const Json& count, const std::string& one) {
    return count.is_null() ? one + "s not told" : counted(count.get<int>(), one);
}

std::string on_or_off(const Json& value) {
    return value.is_null() ? "not told" : value.get<bool>() ? "on" : "off";
}

std::string machine_lines(const Json& machine) {
    const Json& available = machine["memory_available_bytes"];
    return line("host", text_of(machine["host"]) + ", " + text_of(machine["operating_system"]) +
                            (machine["virtualised"].get<bool>() ? ", a virtual machine" : "")) +
           line("memory", bytes_text(machine["memory_bytes"]) +
                              (available.is_null() ? "" : ", " + bytes_text(available) + " available"));
}

std::string topology_lines(const Json& cpu_model, const Json& topology) {
    const std::string source = text_of(topology["source"]);
    const std::string untold = "not told by " + source + "; remedy: build with libhwloc-dev";
    std::string caches;
    for (const Json& cache : topology["caches"]) {
        caches += number_text(cache["count"].get<int>()) + " " + text_of(cache["name"]) + " of " +
                  bytes_text(cache["bytes"]) + ", ";
    }
    const Json& nodes = topology["numa_nodes"];
    return line("CPU", text_of(cpu_model) + ": " + plural(topology["packages"], "package") + ", " +
                           plural(topology["cores"], "core") + ", " +
                           plural(topology["hardware_threads"], "hardware thread") + ", SMT " +
                           on_or_off(topology["smt"])) +
           line("caches", caches.empty() ? untold : caches + "told by " + source) +
           line("NUMA", nodes.is_null() ? untold : plural(nodes, "node"));
}

std::string processor_lines(const Json& frequency, const Json& affinity, bool is_virtual) {
    const bool host_decides = frequency["governor"].is_null() && is_virtual;
    const bool is_part = affinity["affinity_count"] < affinity["hardware_threads"];
    std::string text =
        line("frequency", "governor " + text_of(frequency["governor"]) + ", turbo " +
                              on_or_off(frequency["turbo"]) +
                              (host_decides ? "; the host of this virtual machine decides" : "")) +
        line("affinity",
             plural(affinity["affinity_count"], "CPU") + ": " + text_of(affinity["affinity"]) +
                 (is_part ? ", of " + plural(affinity["hardware_threads"], "hardware thread") : ""));
    if (const Json& quota = affinity["cpu_quota"]; !quota.is_null()) {
        text +=
            line("CPU quota", format("time of %.4g processor%s in all (cgroup); on more threads than that "
                                     "each is halted for a part of the time",
                                     quota.get<double>(), quota == 1 ? "" : "s"));
    }
    return text + line("threads", "Carom takes " + plural(affinity["threads_by_default"], "thread") +
                                      " by default, on " +
                                      plural(affinity["usable_processors"], "usable processor"));
}

std::string openmp_lines(const Json& openmp) {
    std::string environment;
    for (const auto& [name, value] : openmp["environment"].items()) {
        environment += (environment.empty() ? "" : " ") + name + "=" + text_of(value);
    }
    return line("OpenMP", text_of(openmp["runtime"]) + ", version " +
                              number_text(openmp["version"].get<int>()) + ", " +
                              plural(openmp["max_threads"], "thread") + " by default, dynamic " +
                              on_or_off(openmp["dynamic"]) + ", bind " + text_of(openmp["proc_bind"]) + ", " +
                              plural(openmp["places"], "place")) +
           line("", environment.empty() ? "no OMP_*, GOMP_* or KMP_* variable is set" : environment);
}

/// What is counted, and the events that are missing for one reason together.
std::string source_lines(const Json& source) {
    const std::string name = source["source"];
    const std::vector<std::string> events = source["events"];
    const auto joined = [](const auto& all) { return CLI::detail::join(all, ", "); };
    std::string text;
    if (!events.empty()) {
        text =
            line("", name + " counts " +
                         (name.starts_with("papi") ? joined(events) + ", in " + plural(source["runs"], "run")
                                                   : counted(events.size(), "figure")));
    }
    nlohmann::ordered_map<std::string, std::vector<std::string>> missing;
    for (const Json& one : source["missing"]) {
        missing[text_of(one["reason"]) + "; remedy: " + text_of(one["remedy"])].push_back(one["event"]);
    }
    for (const auto& [why, all] : missing) {
        text += line("", name + " cannot count " + joined(all) + ": " + why);
    }
    return text;
}

std::string counter_lines(const Json& perf, const Json& counters) {
    const Json& paranoid = perf["paranoid"];
    std::string text =
        line("counters", "PAPI " + text_of(perf["papi"]) + "; perf_event_paranoid " +
                             (paranoid.is_null() ? "not told" : number_text(paranoid.get<int>())) +
                             (perf["pmu"].get<bool>() ? "" : "; no performance-monitoring unit (PMU)"));
    for (const Json& source : counters) {
        text += source_lines(source);
    }
    return text;
}

std::string software_lines(const Json& tools, const Json& slurm) {
    std::string text = line("program", "built by " + build_text());
    for (const auto& [name, version] : tools.items()) {
        const std::string package = name == "clang++" ? "clang" : name == "perf" ? "linux-perf" : name;
        text += line(name, version.is_null() ? "not on PATH; remedy: install the package " + package
                                             : text_of(version));
    }
    const Json& job = slurm["job"];
    return text +
           line("Slurm",
                (slurm["version"].is_null() ? "srun not on PATH" : text_of(slurm["version"])) +
                    (job.is_null() ? ", not inside a job"
                                   : ", inside job " + job.value("SLURM_JOB_ID", std::string("not named"))));
}

std::string noise_line(const Json& noise) {
    const Json& steal = noise["steal"];
    return line(
        "noise",
        format("%d equal spins of %.3g ms: 95 %% within %.3f, the slowest %.2f times the median; steal "
               "time ",
               noise["spins"].get<int>(), 1e3 * noise["median_seconds"].get<double>(),
               noise["p95_over_median"].get<double>(), noise["max_over_median"].get<double>()) +
            (steal.is_null() ? "not told" : format("%.1f %%", 100 * steal.get<double>())));
}

} // namespace

std::string noise_figure(const Noise& noise) {
    constexpr double most = 40;
    double widest = 1e-9;
    for (const Neighbours& one : noise.neighbours) {
        widest = std::max(widest, one.difference);
    }
    std::string text = "turns of   neighbours differ by   a second of turns leaves open\n";
    for (const Neighbours& one : noise.neighbours) {
        const auto length = static_cast<std::size_t>(std::ceil(most * one.difference / widest));
        text += format("%5.0f ms   %17.2f %%   %25.3f %%   %s\n", 1e3 * one.seconds, 100 * one.difference,
                       100 * one.difference * std::sqrt(one.seconds), std::string(length, '#').c_str());
    }
    return text;
}

std::string doctor_text(const Json& findings) {
    const Json& machine = findings["machine"];
    return machine_lines(machine) + topology_lines(machine["cpu_model"], findings["topology"]) +
           processor_lines(findings["frequency"], findings["affinity"], machine["virtualised"]) +
           openmp_lines(findings["openmp"]) + counter_lines(findings["perf_events"], findings["counters"]) +
           software_lines(findings["tools"], findings["slurm"]) + noise_line(findings["noise"]);
}

} // namespace carom
