#include <algorithm>
#include <cstddef>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/scenes/scene_file.hpp"
#include "harness/tests/program.hpp"
#include "harness/tests/temporary_directory.hpp"
#include "kernels/tests/scenes.hpp"

namespace carom {
namespace {

using tests::ProgramResult;
using tests::refused;
using tests::run_carom;
using tests::TemporaryDirectory;

class CommandLine : public testing::Test {
  protected:
    TemporaryDirectory directory;
    std::string scene = directory.write("scene.in", scene_text(tests::corner()));
};

/// The length of the longest line.
std::size_t width(const std::string& text) {
    std::size_t longest = 0;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        longest = std::max(longest, line.size());
    }
    return longest;
}

TEST_F(CommandLine, HelpsWithTheProgramAndEveryVerb) {
    const ProgramResult help = run_carom({"--help"});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_EQ(help.error, "");
    EXPECT_LE(width(help.output), 80);
    for (const std::string verb : {"list", "run", "check", "bench", "profile", "generate", "reference",
                                   "doctor", "limits", "turns", "help"}) {
        const bool is_listed = verb != "turns" && verb != "help";
        EXPECT_EQ(help.output.find("\n  " + verb + ' ') != std::string::npos, is_listed) << verb;
        const ProgramResult verb_help = run_carom({verb, "--help"});
        EXPECT_EQ(verb_help.exit_code, 0) << verb;
        EXPECT_EQ(verb_help.error, "") << verb;
        EXPECT_NE(verb_help.output.find("--help"), std::string::npos) << verb;
        EXPECT_LE(width(verb_help.output), 80) << verb_help.output;
    }
}

TEST_F(CommandLine, TellsItsVersion) {
    const std::string version = run_carom({"--version"}).output;
    EXPECT_TRUE(std::regex_match(
        version,
        std::regex("carom " CAROM_VERSION " \\((commit [0-9a-f]{12}( with changes)?|unknown commit)\\)\n")))
        << version;
}

TEST_F(CommandLine, HelpShowsTheDefaults) {
    const std::string help = run_carom({"run", "--help"}).output;
    for (const char* option :
         {"SCENE", "THREADS", "--threads", "--variant TEXT=auto", "--substeps", "--tolerance", "relative",
          "--sweep-limit", "100000", "--trajectory", "--json"}) {
        EXPECT_NE(help.find(option), std::string::npos) << option;
    }
}

TEST_F(CommandLine, RefusesAVariantThatThereIsNotAndNamesTheNearest) {
    for (const char* verb : {"run", "check"}) {
        const auto refused_for = [&](const std::string& found, const std::string& nearest) {
            const ProgramResult result = run_carom({verb, scene, "--variant", found});
            return refused(result, 1, {found + "', expected a name", nearest + "'"});
        };
        EXPECT_TRUE(refused_for("publishd", "published"));
        EXPECT_TRUE(refused_for("row-resolv_dynamic", "row-resolve_dynamic"));
        EXPECT_TRUE(refused_for("self-contained-off", "self_contained_off"));
        EXPECT_TRUE(refused_for("trak", "track"));
    }
}

TEST_F(CommandLine, RefusesThreadsThatItDoesNotGet) {
    for (const char* verb : {"run", "check", "bench", "profile"}) {
        EXPECT_TRUE(refused(run_carom({verb, scene, "--threads", "2"}, {"OMP_THREAD_LIMIT=1"}), 1,
                            {"--threads", "found 2", "OpenMP grants 1"}))
            << verb;
    }
}

TEST_F(CommandLine, RefusesTuningsThatCannotBe) {
    for (const char* option : {"--find-chunk", "--resolve-chunk", "--substeps", "--sweep-limit"}) {
        for (const char* value : {"0", "-5", "many", "99999999999"}) {
            EXPECT_TRUE(refused(run_carom({"run", scene, option, value}), 1, {option})) << value;
        }
    }
    EXPECT_TRUE(refused(run_carom({"run", scene, "--tolerance", "strict"}), 1, {"--tolerance", "strict"}));
}

TEST_F(CommandLine, RefusesABadSceneWithItsLine) {
    const std::string bad = directory.write("bad.in", "1\n10\n1\n5\n0 5 five 0 0\n");
    const std::string missing = directory / "missing.in";
    for (const char* verb : {"run", "check"}) {
        EXPECT_TRUE(refused(run_carom({verb, bad}), 1, {bad + ":5: found 'five', expected a position y"}));
        EXPECT_TRUE(refused(run_carom({verb, missing}), 1, {missing + ": cannot be read"}));
        EXPECT_TRUE(refused(run_carom({verb, directory / "."}), 1, {"cannot be read"}));
    }
}

TEST_F(CommandLine, SaysSoIfStandardOutputHasNoRoom) {
    for (const auto& arguments :
         std::vector<std::vector<std::string>>{{"list"},
                                               {"list", "--names"},
                                               {"list", "--json"},
                                               {"run", scene},
                                               {"run", scene, "--json"},
                                               {"check", scene},
                                               {"generate", "9", "10", "1", "5", "0", "1"}}) {
        SCOPED_TRACE(testing::PrintToString(arguments));
        EXPECT_TRUE(refused(run_carom(arguments, {}, "/dev/full"), 1, {"standard output"}));
    }
}

} // namespace
} // namespace carom
