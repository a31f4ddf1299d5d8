#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/scenes/scene_file.hpp"
#include "harness/support/errors.hpp"
#include "harness/tests/temporary_directory.hpp"

namespace carom {
namespace {

using namespace std::string_literals;

struct BadFile {
    std::string name;
    std::string text;
    std::string message;
};

void PrintTo(const BadFile& file, std::ostream* stream) { *stream << file.name; }

/// A scene of two discs with some text in place of the lines of its discs.
std::string with_discs(const std::string& lines) { return "2\n10\n1\n5\n" + lines; }

/// A scene of one disc with other header lines.
std::string with_header(const std::string& lines) { return lines + "0 5 5 0 0\n"; }

const std::vector<BadFile> bad_files{
    {"Empty", "", "bad.in:1: found the end of the file, expected the number of discs N, an integer"},
    {"BlankFirstLine", "\n10\n1\n5\n",
     "bad.in:1: found the end of the line, expected the number of discs N, an integer"},
    {"BinaryGarbage", "\x7f\x45LF\x02\x01\x01\0\0\xff\xfe"s,
     "bad.in:1: found '?ELF" + std::string(7, '?') + "', expected the number of discs N"},
    {"ByteOrderMark",
     "\xef\xbb\xbf"
     "0\n10\n1\n5\n",
     "bad.in:1: found '???0', expected the number of discs N"},
    {"OlderFormat", "print\n1\n10\n1\n5\n0 5 5 0 0\n",
     "bad.in:1: found 'print', expected the number of discs N, an integer (this is the older format, whose "
     "first "
     "line is `print` or `perf`: `tail -n +2 FILE > NEW` converts it)"},
    {"OlderFormatWithCarriageReturns", "perf\r\n1\r\n10\r\n1\r\n5\r\n0 5 5 0 0\r\n",
     "bad.in:1: found 'perf', expected the number of discs N, an integer (this is the older format"},
    {"OlderWordElsewhere", "1\nprint\n1\n5\n0 5 5 0 0\n",
     "bad.in:2: found 'print', expected the side of the box L, a number"},
    {"CountNotANumber", "two\n10\n1\n5\n",
     "bad.in:1: found 'two', expected the number of discs N, an integer"},
    {"CountNotAnInteger", "2.5\n10\n1\n5\n",
     "bad.in:1: found '2.5', expected the number of discs N, an integer"},
    {"CountWithAPlus", "+2\n10\n1\n5\n", "bad.in:1: found '+2', expected the number of discs N, an integer"},
    {"CountNegative", "-1\n10\n1\n5\n", "bad.in:1: found -1, expected a number of discs from 0 to 100000000"},
    {"CountAbsurd", "100000001\n10\n1\n5\n",
     "bad.in:1: found 100000001, expected a number of discs from 0 to 100000000"},
    {"CountBeyondIntegers", "99999999999999999999\n10\n1\n5\n",
     "bad.in:1: found '99999999999999999999', expected the number"},
    {"CountTooLargeForTheFile", "99999999\n10\n1\n5\n0 5 5 0 0\n",
     "bad.in:1: found 99999999 discs in a file too short for so many, expected a line `i x y vx vy` for "
     "each"},
    {"CountWithMoreOnItsLine", "1 10\n1\n5\n0 5 5 0 0\n",
     "bad.in:1: found '10', expected the end of the line"},
    {"SideMissing", "0\n", "bad.in:2: found the end of the file, expected the side of the box L, a number"},
    {"SideNotANumber", "0\nwide\n1\n5\n", "bad.in:2: found 'wide', expected the side of the box L, a number"},
    {"SideNan", with_header("1\nnan\n1\n5\n"), "bad.in:2: found nan, expected a side from 2r = 2 to 1e"},
    {"SideInfinite", with_header("1\ninf\n1\n5\n"), "bad.in:2: found inf, expected a side from 2r = 2 to 1e"},
    {"SideBelowADiameter", with_header("1\n1.99\n1\n5\n"),
     "bad.in:2: found 1.99, expected a side from 2r = 2 to 1e"},
    {"SideNegative", with_header("1\n-10\n1\n5\n"), "bad.in:2: found -10, expected a side from 2r = 2 to 1e"},
    {"SideAbsurd", with_header("1\n1e61\n1\n5\n"),
     "bad.in:2: found 1e+61, expected a side from 2r = 2 to 1e"},
    {"SideBeyondDoubles", with_header("1\n1e999\n1\n5\n"),
     "bad.in:2: found '1e999', expected the side of the box L, a number"},
    {"SideWithADecimalComma", with_header("1\n10,5\n1\n5\n"),
     "bad.in:2: found '10,5', expected the side of the box L, a number"},
    {"SideInHexadecimal", with_header("1\n0x10\n1\n5\n"),
     "bad.in:2: found '0x10', expected the side of the box L, a number"},
    {"RadiusMissing", "0\n10\n", "bad.in:3: found the end of the file, expected the radius r, a number"},
    {"RadiusZero", with_header("1\n10\n0\n5\n"), "bad.in:3: found 0, expected a radius from 1e-60 to 1e"},
    {"RadiusNegative", with_header("1\n10\n-1\n5\n"),
     "bad.in:3: found -1, expected a radius from 1e-60 to 1e"},
    {"RadiusNan", with_header("1\n10\nNaN\n5\n"), "bad.in:3: found nan, expected a radius from 1e-60 to 1e"},
    {"RadiusAbsurdlySmall", with_header("1\n10\n1e-61\n5\n"),
     "bad.in:3: found 1e-61, expected a radius from 1e-60 to 1e"},
    {"RadiusAbsurdlyLarge", with_header("1\n1e60\n1e61\n5\n"),
     "bad.in:3: found 1e+61, expected a radius from 1e-60 to 1e"},
    {"StepsMissing", "0\n10\n1\n",
     "bad.in:4: found the end of the file, expected the number of steps S, an integer"},
    {"StepsNotAnInteger", with_header("1\n10\n1\n1e3\n"),
     "bad.in:4: found '1e3', expected the number of steps S, an integer"},
    {"StepsNegative", with_header("1\n10\n1\n-5\n"),
     "bad.in:4: found -5, expected a number of steps of at least 0"},
    {"StepsBeyondIntegers", with_header("1\n10\n1\n4000000000\n"),
     "bad.in:4: found '4000000000', expected the number of steps S"},
    {"DiscsMissing", with_discs(""), "bad.in:1: found 2 discs in a file too short for so many"},
    {"OnlyDiscMissing", "1\n10\n1\n5\n", "bad.in:1: found 1 disc in a file too short for so many"},
    {"OneDiscMissing", with_discs("0 5.00000 5.00000 0 0\n"),
     "bad.in:6: found the end of the file, expected one line `i x y vx vy` for each"},
    {"BlankLineForADisc", with_discs("0 5 5 0 0\n\n1 7.00000 7 0 0\n"),
     "bad.in:6: found the end of the line, expected the number of a disc, an integer"},
    {"OneDiscTooMany", with_discs("0 5 5 0 0\n1 7 7 0 0\n2 3 3 0 0\n"),
     "bad.in:7: found '2', expected the end of the file after the last disc"},
    {"TrailingGarbage", with_discs("0 5 5 0 0\n1 7 7 0 0\n\nend\n"),
     "bad.in:8: found 'end', expected the end of the file after the last disc"},
    {"TrailingZeroByte", with_discs("0 5 5 0 0\n1 7 7 0 0\n\0"s),
     "bad.in:7: found '?', expected the end of the file after the last disc"},
    {"IndexNotAnInteger", with_discs("zero 5 5 0 0\n1 7 7 0 0\n"),
     "bad.in:5: found 'zero', expected the number of a disc, an integer"},
    {"IndexNegative", with_discs("-1 5 5 0 0\n1 7 7 0 0\n"),
     "bad.in:5: found disc -1, expected a disc from 0 to 1"},
    {"IndexTooLarge", with_discs("0 5 5 0 0\n2 7 7 0 0\n"),
     "bad.in:6: found disc 2, expected a disc from 0 to 1"},
    {"IndexTwice", with_discs("1 5 5 0 0\n1 7 7 0 0\n"),
     "bad.in:6: found disc 1 for the second time, expected each disc once"},
    {"FieldMissing", with_discs("0 5 5 0\n1 7.00 7 0 0\n"),
     "bad.in:5: found the end of the line, expected a velocity vy"},
    {"FieldTooMany", with_discs("0 5 5 0 0\n1 7 7 0 0 9\n"),
     "bad.in:6: found '9', expected the end of the line"},
    {"XNotANumber", with_discs("0 5 5 0 0\n1 seven 7 0 0\n"),
     "bad.in:6: found 'seven', expected a position x"},
    {"XWithMoreAtItsEnd", with_discs("0 5 5 0 0\n1 7m 7 0 0\n"),
     "bad.in:6: found '7m', expected a position x"},
    {"YNan", with_discs("0 5 nan 0 0\n1 7 7 0 0\n"),
     "bad.in:5: found nan, expected a position y of magnitude at most 1e"},
    {"YAbsurd", with_discs("0 5 -1e61 0 0\n1 7 7 0 0\n"),
     "bad.in:5: found -1e+61, expected a position y of magnitude at most 1e"},
    {"VxInfinite", with_discs("0 5 5 -inf 0\n1 7 7 0 0\n"),
     "bad.in:5: found -inf, expected a velocity vx of magnitude at most 1e"},
    {"VyNotANumber", with_discs("0 5 5 0 --1\n1 7 7 0 0\n"), "bad.in:5: found '--1', expected a velocity vy"},
    {"LongField", with_discs("0 5 5 0 " + std::string(1000, 'x') + "\n1 7 7 0 0\n"),
     "bad.in:5: found '" + std::string(40, 'x') + "...', expected a velocity vy"},
    {"FieldsSeparatedByCommas", with_discs("0,5,5,0,0\n1,7,7,0,0\n"),
     "bad.in:5: found '0,5,5,0,0', expected the number of a disc, an integer"}};

class BadSceneFile : public testing::TestWithParam<BadFile> {};

TEST_P(BadSceneFile, IsRefusedWithItsPlace) {
    try {
        parse_scene(GetParam().text, "bad.in");
        FAIL() << "accepted";
    } catch (const InputError& error) {
        EXPECT_PRED_FORMAT2(testing::IsSubstring, GetParam().message, error.what());
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
}

INSTANTIATE_TEST_SUITE_P(Table, BadSceneFile, testing::ValuesIn(bad_files),
                         [](const auto& file) { return file.param.name; });

std::string refusal_to_read(const std::string& path) {
    try {
        read_scene(path);
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(UnreadableSceneFile, IsRefusedWithItsName) {
    const tests::TemporaryDirectory directory;
    const std::string missing = directory / "missing.in";
    EXPECT_EQ(refusal_to_read(missing),
              missing + ": cannot be read (No such file or directory), expected a readable file");
    const std::string folder = directory / ".";
    EXPECT_EQ(refusal_to_read(folder),
              folder + ": cannot be read (Is a directory), expected a readable file");
}

TEST(UnreadableSceneFile, NamesTheFileOfABadLine) {
    const tests::TemporaryDirectory directory;
    const std::string path = directory.write("some scene.in", "two\n");
    EXPECT_EQ(refusal_to_read(path), path + ":1: found 'two', expected the number of discs N, an integer");
}

} // namespace
} // namespace carom
