#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <zlib.h>

#include "harness/scenes/scene_file.hpp"
#include "harness/tests/program.hpp"
#include "harness/tests/temporary_directory.hpp"
#include "kernels/tests/scenes.hpp"
#include "variants/registry.hpp"

namespace carom {
namespace {

using tests::content_of;
using tests::ProgramResult;
using tests::refused;
using tests::run_carom;

/// What `carom check` says of trajectories of one scene.
class CheckTrajectory : public testing::Test {
  protected:
    static constexpr int steps = 6;

    void SetUp() override {
        directory.write("scene.in", scene_text(scene));
        ASSERT_EQ(run_carom({"run", path, "2", "--variant", "published", "--trajectory", directory / "right"})
                      .exit_code,
                  0);
        right = content_of(directory / "right");
    }

    ProgramResult check(const std::string& text, const std::vector<std::string>& more = {}) {
        return check_file(directory.write("trajectory", text), more);
    }

    ProgramResult check_file(const std::string& file, const std::vector<std::string>& more = {}) {
        std::vector<std::string> words{"check", path, "--trajectory", file};
        words.insert(words.end(), more.begin(), more.end());
        return run_carom(words);
    }

    /// The states of the right trajectory, changed from a step on, as a trajectory again.
    std::string changed(const std::function<void(int step, std::vector<Disc>& discs)>& change) const {
        std::string text;
        std::istringstream lines(right);
        for (int step = 0; step <= steps; ++step) {
            std::vector<Disc> discs(scene.discs.size());
            for (std::size_t line = 0; line < discs.size(); ++line) {
                int of_step = 0;
                std::size_t i = 0;
                lines >> of_step >> i;
                lines >> discs[i].x >> discs[i].y >> discs[i].vx >> discs[i].vy;
            }
            change(step, discs);
            for (std::size_t i = 0; i < discs.size(); ++i) {
                text += std::to_string(step) + " ";
                append_disc(text, i, discs[i]);
            }
        }
        return text;
    }

    const Scene scene = tests::random_scene(80, 40, 1, steps, 1.5, 31);
    tests::TemporaryDirectory directory;
    const std::string path = directory / "scene.in";
    std::string right;
};

TEST_F(CheckTrajectory, PassesWhatEveryVariantWrites) {
    for (const Variant& variant : variants()) {
        const std::string name(variant.name);
        const std::string file = directory / "of_variant";
        ASSERT_EQ(run_carom({"run", path, "2", "--variant", name, "--trajectory", file}).exit_code, 0)
            << name;
        const ProgramResult result = check_file(file, {"--variant", name});
        EXPECT_EQ(result.exit_code, 0) << name << ": " << result.error;
        EXPECT_TRUE(result.output.starts_with("passed: " + file + ", 6 steps of 80 discs")) << result.output;
    }
}

TEST_F(CheckTrajectory, PassesLinesInAnyOrderBlankOnesAndGzip) {
    std::vector<std::string> lines;
    std::istringstream text(right);
    for (std::string line; std::getline(text, line);) {
        lines.push_back(line);
    }
    std::string shuffled;
    for (std::size_t step = 0; step < lines.size(); step += 80) {
        for (std::size_t k = 80; k-- > 0;) {
            shuffled += "  " + lines[step + k] + " \r\n\n";
        }
    }
    EXPECT_EQ(check(shuffled).error, "");
    EXPECT_EQ(check(shuffled.substr(0, shuffled.size() - 4)).error, "") << "without a last line's end";
    const std::string compressed = directory / "right.gz";
    gzFile file = gzopen(compressed.c_str(), "wb");
    gzwrite(file, right.data(), static_cast<unsigned>(right.size()));
    gzclose(file);
    EXPECT_EQ(check_file(compressed).error, "");
}

TEST_F(CheckTrajectory, RefusesADiscThatMovedTooLittle) {
    const std::string text = changed([](int step, std::vector<Disc>& discs) {
        if (step == 3) {
            discs[7].x -= 0.001 * discs[7].vx;
        }
    });
    EXPECT_TRUE(refused(check(text), 2, {"trajectory", "step 3: disc 7 moved from"}));
}

TEST_F(CheckTrajectory, RefusesAPairThatIsLeftColliding) {
    // As if nobody had collided in the last step.
    std::vector<Disc> before;
    const std::string text = changed([&before](int step, std::vector<Disc>& discs) {
        for (std::size_t i = 0; step == steps && i < discs.size(); ++i) {
            discs[i].vx = before[i].vx;
            discs[i].vy = before[i].vy;
        }
        before = discs;
    });
    EXPECT_TRUE(refused(check(text), 2, {"step 6: ", "left"}));
}

TEST_F(CheckTrajectory, RefusesEnergyThatIsAMillionthOff) {
    const std::string text = changed([](int step, std::vector<Disc>& discs) {
        if (step == steps) {
            for (Disc& disc : discs) {
                disc.vx *= 1 + 0.5e-6;
                disc.vy *= 1 + 0.5e-6;
            }
        }
    });
    EXPECT_TRUE(refused(check(text), 2, {"step 6: "}));
}

TEST_F(CheckTrajectory, SaysWhenTheFileHasTooFewDigits) {
    std::string text;
    std::istringstream lines(right);
    int step = 0;
    std::size_t i = 0;
    Disc disc{};
    while (lines >> step >> i >> disc.x >> disc.y >> disc.vx >> disc.vy) {
        const bool is_start = step == 0;
        text += std::to_string(step) + " " + std::to_string(i);
        for (const double value : {disc.x, disc.y, disc.vx, disc.vy}) {
            std::ostringstream number;
            number.precision(is_start ? 17 : 8);
            number << value;
            text += " " + number.str();
        }
        text += "\n";
    }
    EXPECT_EQ(check(text).exit_code, 2);
}

} // namespace
} // namespace carom
