#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/tests/program.hpp"
#include "variants/event_driven_variant.hpp"
#include "variants/registry.hpp"

namespace carom {
namespace {

using tests::run_carom;

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) {
        lines.push_back(line);
    }
    return lines;
}

TEST(ListCommand, NamesEveryVariantOnALineThePublishedBestFirstAndTheEventDrivenLast) {
    const auto result = run_carom({"list", "--names"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.error, "");
    std::vector<std::string> expected;
    for (const Variant& variant : variants()) {
        expected.emplace_back(variant.name);
    }
    expected.emplace_back(event_driven().name);
    EXPECT_EQ(lines_of(result.output), expected);
    EXPECT_EQ(lines_of(result.output)[0], "published");
}

TEST(ListCommand, GivesEveryPolicyAsJson) {
    const auto list = nlohmann::json::parse(run_carom({"list", "--json"}).output);
    ASSERT_EQ(list.size(), variants().size() + 1);
    EXPECT_EQ(list[0], nlohmann::json::parse(R"({"name": "published", "policies": {
        "neighbourhood": "four", "order": "checkered", "self_contained": "on", "direction": "reverse",
        "find_schedule": "guided_chunk", "resolve_schedule": "guided_chunk", "storage": "numbered",
        "prefetch": "off", "box_side": "wide", "overlaps": "lists", "search": "exact", "worklist": "all", "impact": "step_end",
        "precision": "double"},
        "same_bits": {"threads": true, "compilers": true}})"));
    for (std::size_t i = 0; i < variants().size(); ++i) {
        EXPECT_EQ(list[i]["name"], variants()[i].name);
        EXPECT_EQ(list[i]["same_bits"], list[0]["same_bits"]);
        EXPECT_EQ(list[i]["policies"]["resolve_schedule"].is_null(),
                  is_sequential(variants()[i].policies.order));
    }
    for (const auto& [policy, choice] : list.back()["policies"].items()) {
        const bool means_something = policy == "impact" || policy == "precision";
        EXPECT_EQ(choice.is_null(), !means_something) << policy;
    }
}

TEST(ListCommand, ShowsThePublishedPoliciesALineForEachVariantAndWhatIsPromised) {
    const std::string output = run_carom({"list"}).output;
    const auto lines = lines_of(output);
    for (const Variant& variant : variants()) {
        EXPECT_EQ(std::ranges::count(lines, variant.name), 1) << variant.name;
    }
    EXPECT_EQ(lines.front(), "published");
    EXPECT_EQ(std::ranges::count(lines, "    storage           numbered"), 1);
    for (const char* part :
         {"any number of threads, any schedule and any chunk: all", "with every compiler, contraction off: ",
          "Without steps, and with none of these policies:\nevent_driven\n", "one thread", "no --substeps",
          "overlap at the start"}) {
        EXPECT_PRED_FORMAT2(testing::IsSubstring, part, output);
    }
}

} // namespace
} // namespace carom
