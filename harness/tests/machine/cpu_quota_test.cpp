#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/machine/threads.hpp"
#include "harness/support/input_file.hpp"
#include "harness/tests/temporary_directory.hpp"

namespace carom {
namespace {

/// The same cases are those of the study's own reader (experiments/tests/plan/test_cpu_quota.py).
TEST(CpuQuota, IsTheLeastOfTheGroupsAroundTheProcess) {
    const auto cases = nlohmann::json::parse(read_file(CAROM_CPU_QUOTAS));
    ASSERT_GT(cases.size(), 30U);
    for (const auto& one : cases) {
        const tests::TemporaryDirectory root;
        for (const auto& [name, content] : one["files"].items()) {
            std::filesystem::create_directories(std::filesystem::path(root / name).parent_path());
            root.write(name, content.get<std::string>());
        }
        const auto quota = read_cpu_quota(root / "");
        const auto expected =
            one["quota"].is_null() ? std::nullopt : std::optional(one["quota"].get<double>());
        EXPECT_EQ(quota, expected) << one["name"];
    }
}

TEST(CpuQuota, OfThisProcessLimitsItsThreads) {
    const auto quota = read_cpu_quota();
    EXPECT_GE(usable_processors(), 1);
    if (quota && *quota >= 1) {
        EXPECT_LE(usable_processors(), *quota);
    }
}

} // namespace
} // namespace carom
