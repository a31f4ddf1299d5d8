#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "harness/machine/threads.hpp"
#include "harness/scenes/scene_file.hpp"
#include "harness/tests/program.hpp"
#include "harness/tests/temporary_directory.hpp"
#include "kernels/tests/scenes.hpp"

namespace carom {
namespace {

using tests::ProgramResult;
using tests::refused;
using tests::run_carom;

/// Command lines that are wrong, and the whole of the answer.
class Usage : public testing::Test {
  protected:
    static testing::AssertionResult answers(const std::vector<std::string>& arguments,
                                            const std::string& expected) {
        const ProgramResult result = run_carom(arguments);
        if (const auto refusal = refused(result, 1, {}); !refusal) {
            return refusal;
        }
        return result.error == "carom: " + expected + "\n" ? testing::AssertionSuccess()
                                                           : testing::AssertionFailure() << result.error;
    }

    tests::TemporaryDirectory directory;
    std::string scene = directory.write("scene.in", scene_text(tests::corner()));
};

TEST_F(Usage, ANumberThatIsNoneOrOutOfItsBounds) {
    const std::string threads = ", expected a whole number from 1 to 1024";
    for (const std::string found :
         {"two", "0", "-1", "1025", "1.5", "1e3", "", "0x2", " 2", "99999999999999999999"}) {
        EXPECT_TRUE(
            answers({"run", scene, "--threads", found}, "--threads: found '" + found + "'" + threads));
    }
    EXPECT_TRUE(answers({"run", scene, "two"}, "--threads: found 'two'" + threads));
    EXPECT_TRUE(
        answers({"bench", scene, "--threads", "1", "--threads", "0"}, "--threads: found '0'" + threads));
    EXPECT_TRUE(answers({"generate", "9", "9", "1", "5", "0", "1", "--seed", "-1"},
                        "--seed: found '-1', expected a whole number from 0 to 18446744073709551615"));
    EXPECT_TRUE(answers({"generate", "1e3", "9", "1", "5", "0", "1"},
                        "N: found '1e3', expected a whole number from 0 to 100000000"));
    EXPECT_TRUE(answers({"generate", "9", "wide", "1", "5", "0", "1"}, "L: found 'wide', expected a number"));
    EXPECT_TRUE(answers({"reference", scene, "--time", "nan"},
                        "--time: found 'nan', expected a number from 0 to 1e+60"));
    EXPECT_TRUE(
        answers({"limits", "--seconds", "61"}, "--seconds: found '61', expected a number from 0 to 60"));
}

TEST_F(Usage, ANumberIsDecimal) {
    EXPECT_EQ(run_carom({"generate", "010", "90", "1", "5", "0", "1"}).output.substr(0, 3), "10\n");
}

TEST_F(Usage, AWordThatIsNoChoice) {
    EXPECT_TRUE(answers({"run", scene, "--tolerance", "foo"},
                        "--tolerance: found 'foo', expected relative or published"));
    EXPECT_TRUE(answers({"profile", scene, "--check", "all"},
                        "--check: found 'all', expected last-step or every-step"));
    EXPECT_TRUE(answers({"generate", "9", "9", "1", "5", "0", "1", "--placement", "square"},
                        "--placement: found 'square', expected overlapping, random or lattice"));
}

TEST_F(Usage, ANameThatIsNone) {
    EXPECT_TRUE(
        answers({"runn", scene}, "found 'runn', expected a verb out of `carom --help`; did you mean 'run'?"));
    EXPECT_TRUE(answers({"help", "benhc"}, "found 'benhc', expected a verb out of `carom --help`"));
    EXPECT_TRUE(answers({"generate", "--case", "cradel"},
                        "--case: found 'cradel', expected a name from `carom generate --cases`; did you mean "
                        "'cradle'?"));
    for (const std::string name : {"automatic", "best", "atuo"}) {
        EXPECT_TRUE(
            answers({"run", scene, "--variant", name},
                    "--variant: found '" + name + "', expected a name from `carom list`, such as 'auto'"));
    }
}

TEST_F(Usage, AnOptionThatIsNone) {
    const std::string expected = ", expected an option of `carom run --help`";
    EXPECT_TRUE(answers({"run", scene, "--thread", "2"},
                        "found '--thread'" + expected + "; did you mean '--threads'?"));
    EXPECT_TRUE(answers({"run", scene, "--variannt", "nine"},
                        "found '--variannt'" + expected + "; did you mean '--variant'?"));
    EXPECT_TRUE(answers({"run", scene, "--speed=9"}, "found '--speed'" + expected));
    EXPECT_TRUE(answers({"run", scene, "-x"}, "found '-x'" + expected));
    EXPECT_TRUE(answers({"bench", scene, "--repetitons", "3"},
                        "found '--repetitons', expected an option of `carom bench --help`; did you mean "
                        "'--repetitions'?"));
    EXPECT_TRUE(
        answers({"--frobnicate", "list"}, "found '--frobnicate', expected an option of `carom --help`"));
    EXPECT_TRUE(answers({"--frobnicate"}, "found '--frobnicate', expected an option of `carom --help`"));
}

/// What CLI11 itself finds wrong, it says in words of its own, with the help of the verb behind them.
TEST_F(Usage, TooMuchOrTooLittle) {
    const std::vector<std::pair<std::vector<std::string>, std::vector<std::string>>> wrong{
        {{}, {"found no verb, expected one out of `carom --help`"}},
        {{"run"}, {"SCENE", "`carom run --help`"}},
        {{"reference", scene}, {"--time", "`carom reference --help`"}},
        {{"run", scene, "2", "extra"}, {"extra", "`carom run --help`"}},
        {{"list", "nine"}, {"nine", "`carom list --help`"}},
        {{"run", scene, "2", "--threads", "3"}, {"--threads", "`carom run --help`"}},
        {{"run", scene, "--variant"}, {"--variant", "TEXT", "`carom run --help`"}},
        {{"run", scene, "--threads"}, {"--threads", "N", "`carom run --help`"}},
        {{"bench", scene, "--errors"}, {"--errors", "--record", "`carom bench --help`"}},
        {{"list", "--names", "--json"}, {"--names", "--json", "`carom list --help`"}}};
    for (const auto& [arguments, parts] : wrong) {
        EXPECT_TRUE(refused(run_carom(arguments), 1, parts)) << testing::PrintToString(arguments);
    }
    EXPECT_TRUE(answers({"generate", "40", "100"},
                        "found no R, expected N L R STEPS VMIN VMAX, or --case: `carom generate --help`"));
}

TEST_F(Usage, AFileSaysWhyItCannotBeRead) {
    const std::string missing = directory / "missing.in";
    EXPECT_TRUE(answers({"run", missing},
                        missing + ": cannot be read (No such file or directory), expected a readable file"));
    EXPECT_TRUE(answers({"bench", directory / "."},
                        directory / "." + ": cannot be read (Is a directory), expected a readable file"));
}

TEST_F(Usage, ARecordThatCannotBeWrittenIsToldBeforeTheRun) {
    const std::string nowhere = directory / "missing/record";
    const std::string expected =
        nowhere + ": cannot be written (No such file or directory), expected a writable place with room";
    // Read later than the record's place is asked for: its name would be told instead.
    const std::string missing = directory / "missing.in";
    EXPECT_TRUE(answers({"bench", missing, "--record", nowhere}, expected));
    EXPECT_TRUE(answers({"profile", missing, "--record", nowhere}, expected));
    EXPECT_TRUE(answers({"profile", missing, "--timeline", nowhere}, expected));
    EXPECT_TRUE(answers({"reference", missing, "--time", "1", "--output", nowhere}, expected));
    EXPECT_TRUE(answers({"limits", "--threads", "1", "--record", nowhere}, expected));
}

TEST_F(Usage, MoreThreadsThanProcessorsAreTold) {
    const int crowd = usable_processors() + 1;
    EXPECT_PRED_FORMAT2(testing::IsSubstring, "carom: note: " + std::to_string(crowd) + " threads on ",
                        run_carom({"run", scene, std::to_string(crowd)}).notes);
    EXPECT_EQ(run_carom({"run", scene, "1"}).notes.find("threads on"), std::string::npos);
}

TEST_F(Usage, HelpOfAVerbIsTheVerbsHelp) {
    for (const std::string verb : {"run", "bench", "help"}) {
        const ProgramResult help = run_carom({"help", verb});
        EXPECT_EQ(help.exit_code, 0);
        EXPECT_EQ(help.output, run_carom({verb, "--help"}).output) << verb;
    }
    EXPECT_EQ(run_carom({"help"}).output, run_carom({"--help"}).output);
}

TEST_F(Usage, HelpTellsTheExitCodes) {
    EXPECT_PRED_FORMAT2(testing::IsSubstring, "Exit codes: 0 done; 1 wrong usage",
                        run_carom({"--help"}).output);
}

} // namespace
} // namespace carom
