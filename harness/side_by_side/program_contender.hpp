#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/processes/process_command.hpp"
#include "harness/processes/process_end.hpp"

namespace carom {

/// A program that is measured beside others.
struct ProgramContender {
    ProcessCommand command;
    std::vector<std::string> prepare;  ///< words of a command that is run before each of its runs, untimed
    std::vector<std::string> conclude; ///< and of one that is run after each
    bool fresh_folder = false;         ///< each run has a new and empty folder, which is removed afterwards
    int warm_ups = 0;                  ///< runs before the first that counts
    std::optional<bool> turns;         ///< whether it is sliced; found out if nobody says so
    bool times_itself = false;         ///< it would count as its own time what it stands still
    int most_rounds = 1;               ///< of one that times itself within short processes: how often it runs
    std::optional<int> rounds;         ///< how often it runs, each time without a pause, whatever it is
    double expected_seconds = 0;       ///< how long it takes undisturbed, or 0 where nobody knows

    /// Why a run failed; empty if it did not.
    std::function<std::string(const ProcessEnd&)> failure;
    /// Takes what a run that counts has left behind, before the next begins. Returns why it does not count
    /// after all, or nothing.
    std::function<std::string(const ProcessEnd&)> take = [](const ProcessEnd&) { return std::string(); };
};

/// What became of it.
struct Measured {
    std::vector<ProcessEnd> runs; ///< those that count, one but where it has several rounds
    std::string failure;          ///< why there is none that counts
    bool sliced = false;
    double seconds_alone = 0; ///< of a sliced one, what ran after all others had ended
    std::string undisturbed;  ///< why it had a stretch of its own although it might have been sliced
};

} // namespace carom
