#include <algorithm>
#include <cstddef>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "harness/scenes/disc_lines.hpp"
#include "harness/scenes/scene_file.hpp"
#include "harness/support/errors.hpp"
#include "harness/tests/scenes/same_scene.hpp"
#include "harness/tests/temporary_directory.hpp"
#include "kernels/tests/scenes.hpp"

namespace carom {
namespace {

using tests::same_scene;

constexpr int disc_count = 4000;
constexpr std::size_t header_lines = 4;

/// A scene's file of ten blocks, as lines that a test may change. Whatever it has become, a file is read on
/// any number of threads as from memory.
class LargeSceneFile : public testing::Test {
  protected:
    const Scene scene = tests::random_scene(disc_count, 1000, 1, 7, 2, 221);
    std::vector<std::string> lines = lines_of(scene_text(scene));

    std::string& line_of_disc(std::size_t i) { return lines[header_lines + i]; }

    void expect_scene() {
        const std::string path = write();
        EXPECT_TRUE(same_scene(parse_scene(text(), path), scene));
        for (const int threads : {1, 2, 3, 8}) {
            EXPECT_TRUE(same_scene(read_scene(path, threads), scene)) << threads << " threads";
        }
    }

    /// `line` counts from 1.
    void expect_error(std::size_t line, const std::string& what) {
        const std::string path = write();
        const std::string expected = path + ":" + std::to_string(line) + ": " + what;
        EXPECT_EQ(error_of([&] { parse_scene(text(), path); }), expected);
        for (const int threads : {1, 2, 3, 8}) {
            EXPECT_EQ(error_of([&] { read_scene(path, threads); }), expected) << threads << " threads";
        }
    }

    std::string text() const {
        std::string all;
        for (const std::string& line : lines) {
            all += line + "\n";
        }
        return all;
    }

    std::string write() const { return directory.write("large.in", text()); }

    tests::TemporaryDirectory directory;

  private:
    static std::vector<std::string> lines_of(const std::string& text) {
        std::vector<std::string> lines;
        for (std::size_t begin = 0; begin < text.size();) {
            const std::size_t end = text.find('\n', begin);
            lines.push_back(text.substr(begin, end - begin));
            begin = end + 1;
        }
        return lines;
    }

    template <class Read> static std::string error_of(const Read& read) {
        try {
            read();
        } catch (const InputError& error) {
            return error.what();
        }
        return "accepted";
    }
};

TEST_F(LargeSceneFile, IsReadOnAnyNumberOfThreads) { expect_scene(); }

TEST_F(LargeSceneFile, TakesDiscsInAnyOrder) {
    std::mt19937_64 random(1);
    std::shuffle(lines.begin() + header_lines, lines.end(), random);
    expect_scene();
}

TEST_F(LargeSceneFile, TakesBlanksWhereverLinesAreCutIntoBlocks) {
    for (std::size_t length = 0; length < 400; length += 7) {
        line_of_disc(length) += std::string(length, length % 2 == 0 ? ' ' : '\t') + "\r";
        lines.back() += "\n \r";
    }
    expect_scene();
}

TEST_F(LargeSceneFile, TakesLinesLongerThanABlock) {
    line_of_disc(0).insert(0, 5'000, ' ');
    line_of_disc(2000) += std::string(100'000, ' ');
    expect_scene();
}

TEST_F(LargeSceneFile, TakesBlankLinesWithoutEnd) {
    lines.resize(lines.size() + 100'000);
    expect_scene();
}

TEST_F(LargeSceneFile, TellsWhereverALineIsWrong) {
    for (std::size_t i = 0; i < disc_count; i += 97) {
        const std::string line = line_of_disc(i);
        line_of_disc(i) += " more";
        expect_error(header_lines + i + 1, "found 'more', expected the end of the line");
        line_of_disc(i) = line;
    }
}

TEST_F(LargeSceneFile, TellsTheFirstOfSeveralWrongLines) {
    line_of_disc(3900) = "3900 1 2 3";
    line_of_disc(2100) = "2100 1 2 x 4";
    line_of_disc(1100) = "1100 1 nan 3 4";
    expect_error(header_lines + 1101, "found nan, expected a position y of magnitude at most 1e60");
    line_of_disc(1) = "4000 1 2 3 4";
    expect_error(header_lines + 2, "found disc 4000, expected a disc from 0 to 3999");
}

TEST_F(LargeSceneFile, TellsTheSecondOfTwoLinesForADisc) {
    line_of_disc(3000) = line_of_disc(10);
    expect_error(header_lines + 3001, "found disc 10 for the second time, expected each disc once");
    line_of_disc(3500) = "3500 1 2 3";
    expect_error(header_lines + 3001, "found disc 10 for the second time, expected each disc once");
}

TEST_F(LargeSceneFile, TellsThatALineIsMissingAtTheEnd) {
    lines.erase(lines.begin() + header_lines + 1000);
    expect_error(header_lines + disc_count,
                 "found the end of the file, expected one line `i x y vx vy` for each of the N discs");
}

TEST_F(LargeSceneFile, TellsThatTheFileGoesOn) {
    lines.insert(lines.end(), {"", "end"});
    expect_error(header_lines + disc_count + 2,
                 "found 'end', expected the end of the file after the last disc");
    line_of_disc(2000) = "2000 1 2 3";
    expect_error(header_lines + 2001, "found the end of the line, expected a velocity vy");
}

TEST_F(LargeSceneFile, TellsOfABlankLineBetween) {
    lines.insert(lines.begin() + header_lines + 1500, " ");
    expect_error(header_lines + 1501, "found the end of the line, expected the number of a disc, an integer");
}

TEST_F(LargeSceneFile, IsReadFromAPipe) {
    const std::string path = directory / "pipe";
    ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
    std::thread writer([&] { std::ofstream(path) << text(); });
    EXPECT_TRUE(same_scene(read_scene(path, 2), scene));
    writer.join();
}

TEST(ReadDiscLines, TakesGoodLinesHoweverTheyLieInBlocks) {
    for (const std::size_t length : std::initializer_list<std::size_t>{16, 31, 32, 33, 1024, 4000}) {
        std::vector<Disc> discs(500'000 / length);
        std::string text = "4 lines\n";
        for (std::size_t i = 0; i < discs.size(); ++i) {
            const std::string line = std::to_string(i) + " 1 2 3 4";
            text += line + std::string(length - line.size() - 1, ' ') + "\n";
        }
        const Pieces pieces{text.size(), [&text](std::size_t offset, std::span<char> buffer) {
                                return std::string_view(text).substr(offset, buffer.size());
                            }};
        EXPECT_TRUE(read_disc_lines(pieces, 8, discs, 2)) << length;
        EXPECT_EQ(std::ranges::count(discs, Disc{1, 2, 3, 4}), std::ssize(discs)) << length;
    }
}

TEST(ReadDiscLines, TakesNoLineOfAFileThatBecameShorter) {
    const std::string text = "0 1 2 3 45\n1 1 2 3 45\n";
    std::vector<Disc> discs(2);
    const Pieces pieces{text.size(), [&text](std::size_t offset, std::span<char> buffer) {
                            return std::string_view(text).substr(offset, buffer.size()).substr(0, 20);
                        }};
    EXPECT_FALSE(read_disc_lines(pieces, 0, discs, 1));
}

} // namespace
} // namespace carom
