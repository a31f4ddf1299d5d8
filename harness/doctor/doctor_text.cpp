#include <algorithm>
#include <cmath>

#include <CLI/StringTools.hpp>

#include "harness/doctor/findings.hpp"
#include "harness/support/format.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

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

std::string plural(const std::optional<int>& count, const std::string& one) {
    return count ? counted(*count, one) : one + "s not told";
}

std::string on_or_off(const std::optional<bool>& value) {
    return !value ? "not told" : *value ? "on" : "off";
}

std::string machine_lines(const Machine& machine, const std::optional<std::int64_t>& available) {
    return line("host", machine.host + ", " + machine.operating_system +
                            (machine.virtualised ? ", a virtual machine" : "")) +
           line("memory", bytes_text(machine.memory_bytes) +
                              (available ? ", " + bytes_text(*available) + " available" : ""));
}

std::string topology_lines(const std::string& cpu_model, const Topology& topology) {
    const std::string untold = "not told by " + topology.source + "; remedy: build with libhwloc-dev";
    std::string caches;
    for (const CacheLevel& cache : topology.caches) {
        caches += std::to_string(cache.count) + " " + cache.name + " of " + bytes_text(cache.bytes) + ", ";
    }
    return line("CPU", cpu_model + ": " + plural(topology.packages, "package") + ", " +
                           plural(topology.cores, "core") + ", " +
                           plural(topology.hardware_threads, "hardware thread") + ", SMT " +
                           on_or_off(topology.smt())) +
           line("caches", caches.empty() ? untold : caches + "told by " + topology.source) +
           line("NUMA", topology.numa_nodes ? plural(topology.numa_nodes, "node") : untold);
}

std::string processor_lines(const Findings& findings) {
    const Machine& machine = findings.machine;
    const bool host_decides = !machine.governor && machine.virtualised;
    const bool is_part = machine.affinity_count < machine.hardware_threads;
    std::string text =
        line("frequency", "governor " + machine.governor.value_or("not told") + ", turbo " +
                              on_or_off(findings.turbo) +
                              (host_decides ? "; the host of this virtual machine decides" : "")) +
        line("affinity", counted(machine.affinity_count, "CPU") + ": " + machine.affinity +
                             (is_part ? ", of " + counted(machine.hardware_threads, "hardware thread") : ""));
    if (const auto quota = machine.cpu_quota) {
        text +=
            line("CPU quota", format("time of %.4g processor%s in all (cgroup); on more threads than that "
                                     "each is halted for a part of the time",
                                     *quota, *quota == 1 ? "" : "s"));
    }
    if (machine.has_unread_cpu_quota) {
        text += line("CPU quota", "cannot be read: control groups of version 1 grant the processors here");
    }
    return text +
           line("threads", "Carom takes " + counted(findings.threads_by_default, "thread") +
                               " by default, on " + counted(findings.usable_processors, "usable processor"));
}

std::string openmp_lines(const OpenMp& openmp) {
    const std::string environment = CLI::detail::join(
        openmp.environment, [](const auto& variable) { return variable.first + "=" + variable.second; }, " ");
    return line("OpenMP", openmp.runtime + ", version " + std::to_string(openmp.version) + ", " +
                              counted(openmp.max_threads, "thread") + " by default, dynamic " +
                              on_or_off(openmp.dynamic) + ", bind " + openmp.proc_bind + ", " +
                              counted(openmp.places, "place")) +
           line("", environment.empty() ? "no OMP_*, GOMP_* or KMP_* variable is set" : environment);
}

/// What is counted, and the events that are missing for one reason together.
std::string source_lines(const CounterSource& source) {
    const auto joined = [](const auto& events) { return CLI::detail::join(events, ", "); };
    std::string text;
    if (!source.events.empty()) {
        const bool by_papi = source.name.starts_with("papi");
        text = line("", source.name + " counts " +
                            (by_papi ? joined(source.events) + ", in " + counted(source.runs, "run")
                                     : counted(source.events.size(), "figure")));
    }
    nlohmann::ordered_map<std::string, std::vector<std::string>> missing;
    for (const CounterValue& value : source.missing) {
        missing[value.reason + "; remedy: " + value.remedy].push_back(value.name);
    }
    for (const auto& [why, events] : missing) {
        text += line("", source.name + " cannot count " + joined(events) + ": " + why);
    }
    return text;
}

std::string counter_lines(const Findings& findings) {
    const auto& paranoid = findings.perf.paranoid;
    std::string text =
        line("counters", "PAPI " + findings.papi + "; perf_event_paranoid " +
                             (paranoid ? std::to_string(*paranoid) : "not told") +
                             (lacks_pmu(findings.perf) ? "; no performance-monitoring unit (PMU)" : ""));
    for (const CounterSource& source : findings.counters) {
        text += source_lines(source);
    }
    return text;
}

std::string software_lines(const Findings& findings) {
    std::string text = line("program", "built by " + build_text());
    for (const auto& [name, package, version] : findings.tools) {
        text += line(name, version.empty() ? "not on PATH; remedy: install the package " + package : version);
    }
    const std::string& slurm = findings.slurm_version;
    const auto& job = findings.slurm_job;
    const auto id = job.find("SLURM_JOB_ID");
    const bool is_named = id != job.end();
    return text + line("Slurm", (slurm.empty() ? "srun not on PATH" : slurm) +
                                    (job.empty() ? ", not inside a job"
                                                 : ", inside job " + (is_named ? id->second : "not named")));
}

std::string noise_line(const Noise& noise) {
    return line("noise", format("%d equal spins of %.3g ms: 95 %% within %.3f, the slowest %.2f times the "
                                "median; steal time ",
                                noise.spins, 1e3 * noise.median_seconds, noise.p95_over_median,
                                noise.max_over_median) +
                             (noise.steal ? format("%.1f %%", 100 * *noise.steal) : "not told"));
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

std::string doctor_text(const Findings& findings) {
    return machine_lines(findings.machine, findings.memory_available_bytes) +
           topology_lines(findings.machine.cpu_model, findings.topology) + processor_lines(findings) +
           openmp_lines(findings.openmp) + counter_lines(findings) + software_lines(findings) +
           noise_line(findings.noise);
}

} // namespace carom
