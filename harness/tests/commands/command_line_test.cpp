#include <algorithm>
#include <cstddef>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/machine/threads.hpp"
#include "harness/scenes/scene_file.hpp"
#include "harness/tests/program.hpp"
#include "harness/tests/temporary_directory.hpp"
#include "kernels/tests/scenes.hpp"

namespace carom {
namespace {

using tests::run_carom;

void says(const std::string& part, const std::string& text) {
    EXPECT_PRED_FORMAT2(testing::IsSubstring, part, text);
}

/// What a command prints in good order, in lines that fit a terminal.
std::string help_of(const std::vector<std::string>& words) {
    const tests::ProgramResult result = run_carom(words);
    EXPECT_EQ(result.exit_code, 0) << testing::PrintToString(words);
    EXPECT_EQ(result.error, "");
    std::istringstream lines(result.output);
    for (std::string line; std::getline(lines, line);) {
        EXPECT_LE(line.size(), 80U) << line;
    }
    return result.output;
}

TEST(CommandLine, HelpsWithTheProgramAndEveryVerb) {
    const std::string help = help_of({"--help"});
    EXPECT_EQ(help_of({"help"}), help);
    says("Exit codes: 0 done; 1 wrong usage", help);
    for (const std::string verb : {"list", "run", "check", "bench", "profile", "generate", "reference",
                                   "doctor", "limits", "turns", "help"}) {
        const bool is_listed = verb != "turns" && verb != "help";
        EXPECT_EQ(help.find("\n  " + verb + ' ') != std::string::npos, is_listed) << verb;
        const std::string of_verb = help_of({verb, "--help"});
        says("--help", of_verb);
        EXPECT_EQ(help_of({"help", verb}), of_verb);
    }
}

TEST(CommandLine, HelpShowsTheDefaults) {
    const std::string help = help_of({"run", "--help"});
    for (const char* option :
         {"SCENE", "THREADS", "--threads", "--variant TEXT=auto", "--substeps", "--tolerance", "relative",
          "--sweep-limit", "100000", "--trajectory", "--json"}) {
        says(option, help);
    }
}

TEST(CommandLine, TellsItsVersion) {
    const std::string version = help_of({"--version"});
    EXPECT_TRUE(std::regex_match(
        version,
        std::regex("carom " CAROM_VERSION " \\((commit [0-9a-f]{12}( with changes)?|unknown commit)\\)\n")))
        << version;
}

TEST(CommandLine, TakesNumbersForDecimal) {
    EXPECT_TRUE(run_carom({"generate", "010", "90", "1", "5", "0", "1"}).output.starts_with("10\n"));
}

TEST(CommandLine, TellsOfMoreThreadsThanProcessors) {
    const tests::TemporaryDirectory directory;
    const std::string scene = directory.write("scene.in", scene_text(tests::corner()));
    const std::string crowd = std::to_string(usable_processors() + 1);
    says("carom: note: " + crowd + " threads on ", run_carom({"run", scene, crowd}).notes);
    EXPECT_EQ(run_carom({"run", scene, "1"}).notes.find("threads on"), std::string::npos);
}

} // namespace
} // namespace carom
