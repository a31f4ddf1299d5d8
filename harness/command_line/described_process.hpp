#pragma once

#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/side_by_side/program_contender.hpp"

namespace carom {

/// One program as the file of `carom processes` describes it.
struct DescribedProcess {
    ProgramContender contender; ///< without what its ends are judged by
    std::string record;
    std::vector<std::string> tags;
    std::vector<std::string> sources;
    std::map<std::string, std::string> written; ///< those of the sources that it writes, each with its hash
    std::vector<int> exit_codes{0};             ///< those that are fine
    std::string scene;
    std::string checked;
    int threads = 1;
    nlohmann::ordered_json axes = nlohmann::ordered_json::object();
    nlohmann::ordered_json build = nlohmann::ordered_json::object(); ///< of its record's provenance, what is
                                                                     ///< not as this program's
    double unit_seconds = 1; ///< of the time that it prints, if its command has a pattern
    std::string benchmark;   ///< the case of a Google Benchmark; empty if it is none
    std::string output;      ///< the file that the benchmark writes
};

/// Those that a file describes. Throws InputError, which names the process and the key, before anything runs.
std::vector<DescribedProcess> read_processes(const std::string& path);

} // namespace carom
