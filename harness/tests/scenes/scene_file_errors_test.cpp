#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/scenes/scene_file.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/input_file.hpp"

namespace carom {
namespace {

/// Texts that are no scenes, and what is said of them (bad_scenes.json).
TEST(BadSceneFile, IsRefusedInALineWithItsPlace) {
    for (const auto& row : nlohmann::json::parse(read_file(CAROM_BAD_SCENES))) {
        try {
            parse_scene(row[0].get<std::string>(), "bad.in");
            ADD_FAILURE() << "accepted: " << row;
        } catch (const InputError& error) {
            EXPECT_PRED_FORMAT2(testing::IsSubstring, row[1].get<std::string>(), error.what());
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
        }
    }
}

} // namespace
} // namespace carom
