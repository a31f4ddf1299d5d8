#include <filesystem>
#include <iterator>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/support/input_file.hpp"
#include "harness/tests/program.hpp"
#include "harness/tests/temporary_directory.hpp"

namespace carom {
namespace {

using Json = nlohmann::json;

/// How many files there are.
auto entries(const tests::TemporaryDirectory& directory) {
    return std::distance(std::filesystem::directory_iterator(directory.path()), {});
}

/// The text of a row with `value` in place of {}, and paths in place of @file.
std::string filled(std::string text, const std::string& value, const tests::TemporaryDirectory& directory) {
    if (const auto place = text.find("{}"); place != std::string::npos) {
        text.replace(place, 2, value);
    }
    return std::regex_replace(text, std::regex("@"), directory / "");
}

/// Command lines that are wrong, and the whole of the answer, or parts of it (refusals.json). With `each` a
/// row is several. Nothing of what was to be written stays.
TEST(Refusals, AreOneLineThatSaysWhatWasFoundAndExpected) {
    const Json all = Json::parse(read_file(CAROM_REFUSALS));
    const tests::TemporaryDirectory directory;
    for (const auto& [name, text] : all["files"].items()) {
        directory.write(name, text.get<std::string>());
    }
    for (const Json& row : all["refusals"]) {
        for (const std::string& value : row.value("each", std::vector<std::string>{""})) {
            SCOPED_TRACE(row.dump() + value);
            const auto before = entries(directory);
            std::vector<std::string> words = row["words"];
            for (std::string& word : words) {
                word = filled(word, value, directory);
            }
            const auto result = tests::run_carom(words, row.value("settings", std::vector<std::string>{}),
                                                 row.value("output", ""),
                                                 filled(row.value("input", "/dev/null"), value, directory));
            std::vector<std::string> parts;
            for (const Json& said : row["says"].is_array() ? row["says"] : Json::array({row["says"]})) {
                parts.push_back(filled(said, value, directory));
            }
            EXPECT_TRUE(tests::refused(result, row.value("exit", 1), parts));
            if (row["says"].is_string()) {
                EXPECT_EQ(result.error, "carom: " + parts.front() + "\n");
            }
            EXPECT_EQ(entries(directory), before);
        }
    }
}

} // namespace
} // namespace carom
