#include <clocale>
#include <fstream>
#include <limits>
#include <locale>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "harness/scenes/scene_file.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/text.hpp"
#include "harness/tests/scenes/same_scene.hpp"
#include "harness/tests/temporary_directory.hpp"
#include "kernels/tests/scenes.hpp"

namespace carom {
namespace {

using tests::same_scene;

Scene parse(const std::string& text) { return parse_scene(text, "scene.in"); }

const std::string plain_text = "2\n10.5\n1\n25\n0 1.5 -2 0.25 0\n1 1e-3 4 -1 3.5E2\n";
const Scene plain{.side = 10.5, .radius = 1, .steps = 25, .discs = {{1.5, -2, 0.25, 0}, {0.001, 4, -1, 350}}};

TEST(ParseScene, ReadsThePublishedFormat) { EXPECT_TRUE(same_scene(parse(plain_text), plain)); }

TEST(ParseScene, TakesDiscsInAnyOrder) {
    EXPECT_TRUE(same_scene(parse("2\n10.5\n1\n25\n1 0.001 4 -1 350\n0 1.5 -2 0.25 0\n"), plain));
}

TEST(ParseScene, TakesLineEndsOfEveryKindAndBlanksAround) {
    std::string windows;
    for (const char letter : plain_text) {
        if (letter == '\n') {
            windows += '\r';
        }
        windows += letter;
    }
    EXPECT_TRUE(same_scene(parse(windows), plain));
    EXPECT_TRUE(same_scene(parse(plain_text.substr(0, plain_text.size() - 1)), plain));
    EXPECT_TRUE(same_scene(parse(plain_text + "\n \t\r\n\n"), plain));
    EXPECT_TRUE(same_scene(parse(" 2 \n\t10.5\n1 \n 25\n 0\t1.5  -2 0.25 0 \n1 0.001 4 -1 350\n"), plain));
}

TEST(ParseScene, TakesASceneWithoutDiscsAndOneWithoutSteps) {
    EXPECT_TRUE(same_scene(parse("0\n2\n1\n0\n"), {.side = 2, .radius = 1, .steps = 0, .discs = {}}));
}

TEST(ParseScene, TakesTheLimitsThemselves) {
    const Scene scene = parse("1\n1e60\n1e-60\n2147483647\n0 1e60 -1e60 -1e60 1e60\n");
    EXPECT_EQ(scene.side, 1e60);
    EXPECT_EQ(scene.radius, 1e-60);
    EXPECT_EQ(scene.steps, std::numeric_limits<int>::max());
    EXPECT_EQ(scene.discs[0], (Disc{1e60, -1e60, -1e60, 1e60}));
}

TEST(SceneText, ReadsBackTheSameToTheLastBit) {
    for (const auto& [name, scene] : tests::all_scenes()) {
        EXPECT_TRUE(same_scene(parse(scene_text(scene)), scene)) << name;
    }
    const double least = std::numeric_limits<double>::denorm_min();
    const Scene awkward{
        .side = 0.1 + 0.2,
        .radius = 1.0 / 30,
        .steps = 7,
        .discs = {{-0.0, 0.1, 1.0 / 3, -1e-5}, {5e59, 123456789.123456789, 1e21, 0.30000000000000004}}};
    EXPECT_TRUE(same_scene(parse(scene_text(awkward)), awkward));
    Scene tiny = awkward;
    tiny.discs[0].vx = 2.2250738585072014e-308;
    tiny.discs[0].vy = least;
    EXPECT_TRUE(same_scene(parse(scene_text(tiny)), tiny));
}

TEST(SceneText, IsThePublishedFormat) {
    EXPECT_EQ(scene_text(plain), "2\n10.5\n1\n25\n0 1.5 -2 0.25 0\n1 0.001 4 -1 350\n");
}

TEST(SceneFile, OfAMillionDiscsInAnyOrderIsReadWhole) {
    const Scene scene = tests::random_scene(1'000'000, 30'000, 16, 100, 5, 141);
    std::string text = scene_text(scene);
    const std::size_t header = text.find("\n0 ") + 1;
    const std::size_t half = text.find("\n500000 ") + 1;
    text = text.substr(0, header) + text.substr(half) + text.substr(header, half - header);
    const tests::TemporaryDirectory directory;
    EXPECT_TRUE(same_scene(read_scene(directory.write("large.in", text)), scene));
}

TEST(SceneFile, IsReadFromAPipe) {
    const tests::TemporaryDirectory directory;
    const std::string path = directory / "pipe";
    ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
    const Scene scene = tests::random_scene(4000, 1000, 1, 7, 2, 221);
    std::thread writer([&] { std::ofstream(path) << scene_text(scene); });
    EXPECT_TRUE(same_scene(read_scene(path), scene));
    writer.join();
}

/// Numbers as in much of Europe: 1.234,5.
class CommaNumbers : public std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
};

/// Sets the locale of the standard library, and of C's where the system has one with a decimal comma.
class CommaLocale : public testing::Test {
  protected:
    void SetUp() override {
        for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE", "fr_FR", "nl_NL.UTF-8"}) {
            if (std::setlocale(LC_ALL, name) != nullptr) {
                break;
            }
        }
        std::locale::global(std::locale(std::locale::classic(), new CommaNumbers));
    }
    void TearDown() override {
        std::locale::global(std::locale::classic());
        std::setlocale(LC_ALL, "C");
    }
};

TEST_F(CommaLocale, ChangesNothingInAScene) {
    EXPECT_TRUE(same_scene(parse(plain_text), plain));
    Scene large = plain;
    large.side = 1234567.5;
    large.steps = 123456;
    EXPECT_EQ(scene_text(large), "2\n1234567.5\n1\n123456\n0 1.5 -2 0.25 0\n1 0.001 4 -1 350\n");
    EXPECT_THROW(parse("0\n10,5\n1\n5\n"), InputError);
}

TEST_F(CommaLocale, ChangesNothingInANumber) {
    EXPECT_EQ(number_text(1234.5), "1234.5");
    EXPECT_EQ(number_text(1234567), "1234567");
    // The published programs read the side as a whole number, and would take 1e+05 for 1.
    EXPECT_EQ(number_text(100000.0), "100000");
    EXPECT_EQ(number_text(-2e9), "-2000000000");
    EXPECT_EQ(number_text(-0.0), "-0");
    EXPECT_EQ(number_text(1e+300), "1e+300");
    EXPECT_EQ(number_text(1e-07), "1e-07");
    EXPECT_EQ(parse_number<double>("1234.5"), 1234.5);
    EXPECT_EQ(parse_number<double>("1234,5"), std::nullopt);
}

TEST(ParseNumber, TakesTheWholeTextOrNothing) {
    EXPECT_EQ(parse_number<int>("12"), 12);
    EXPECT_EQ(parse_number<int>("-12"), -12);
    EXPECT_EQ(parse_number<double>("1e3"), 1000);
    for (const char* text : {"", " 1", "1 ", "1x", "+1", "0x1", "1e", "2147483648"}) {
        EXPECT_EQ(parse_number<int>(text), std::nullopt) << text;
    }
}

} // namespace
} // namespace carom
