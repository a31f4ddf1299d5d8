#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/measure/stated_time.hpp"
#include "harness/records/sources.hpp"
#include "harness/side_by_side/program_contender.hpp"

namespace carom {

/// A program that is to be measured, as the file of `carom processes` describes it.
struct DescribedProcess {
    ProgramContender contender;                 ///< without what its ends are judged by
    std::string record;                         ///< the file for its record
    std::vector<std::string> tags;              ///< KEY=VALUE
    std::vector<std::string> sources;           ///< the files that make it up
    std::map<std::string, std::string> written; ///< those of the sources that it writes, each with its hash
    std::vector<int> exit_codes{0};             ///< those that are fine
    std::string scene;                          ///< the file of the scene that it simulates; may be empty
    std::string checked; ///< how its result was checked beforehand; empty if it was not
    int threads = 1;
    nlohmann::ordered_json axes = nlohmann::ordered_json::object();  ///< what was chosen, by name
    nlohmann::ordered_json build = nlohmann::ordered_json::object(); ///< of its record's provenance, what is
                                                                     ///< not as this program's
    std::optional<double> unit_seconds; ///< of a time that it prints without a unit
    std::string benchmark;              ///< the case of a Google Benchmark; empty if it is none
    std::string output;                 ///< the file that the benchmark writes
};

/// What was found of it.
struct ProcessMeasurement {
    /// Reads what it is made of. Throws InputError.
    explicit ProcessMeasurement(DescribedProcess one)
        : its(std::move(one)), sources(its.sources, its.written) {}

    DescribedProcess its;
    Sources sources;                ///< the files that make it up, as they were before it ran
    std::vector<StatedTime> stated; ///< of each run; empty if the time from outside is the one that counts
    int exit_code = 1;              ///< of its last run, as one that failed
    Measured measured;
};

/// The record of a process of which a run counts, of kind "process". `scene` is as scene_json, or null; so
/// many `contenders` were measured beside each other, in an order that was drawn from `seed`. Its provenance
/// is that of this program, which measured it, but for the build, for the environment, and for the hash of
/// the program.
nlohmann::ordered_json process_json(const ProcessMeasurement& measurement,
                                    const nlohmann::ordered_json& scene, int contenders, std::uint64_t seed);

/// What stands in the place of that record, of kind "failure", where no run counts for this reason.
nlohmann::ordered_json failure_json(const ProcessMeasurement& measurement, const std::string& reason);

} // namespace carom
