#include <fstream>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/scenes/scene_file.hpp"
#include "harness/tests/program.hpp"
#include "harness/tests/temporary_directory.hpp"
#include "kernels/tests/scenes.hpp"

namespace carom {
namespace {

using tests::refused;
using tests::run_carom;

class PromisesCommand : public testing::Test {
  protected:
    PromisesCommand() {
        run_carom({"generate", "300", "60", "1", "4", "0.1", "0.4", "--seed", "5", "--placement", "random",
                   "--isotropic", "--output", apart});
    }

    nlohmann::json record() const {
        std::ifstream file(kept);
        return nlohmann::json::parse(file);
    }

    tests::TemporaryDirectory directory;
    const std::string apart = directory / "apart.in";
    const std::string kept = directory / "record.json";
};

TEST_F(PromisesCommand, SaysWhatBecameOfEachBoundOfEachError) {
    const auto result = run_carom({"promises", apart, "--threads", "1", "--record", kept, "--tag", "a=b"});
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_NE(result.output.find("kept "), std::string::npos);
    EXPECT_NE(result.output.find(" of 12\n"), std::string::npos) << result.output;
    const auto record = this->record();
    EXPECT_EQ(record["kind"], "promises");
    EXPECT_EQ(record["tags"]["a"], "b");
    std::set<std::string> measures;
    ASSERT_EQ(record["promises"].size(), 12);
    for (const auto& promise : record["promises"]) {
        measures.insert(promise["measure"]);
        EXPECT_LE(promise["promised"], promise["error_below"]);
        EXPECT_LE(promise["cheapest"]["seconds"], promise["chosen"]["seconds"]);
        if (promise["measure"] == "path") {
            EXPECT_LE(promise["chosen"]["error"], promise["error_below"]) << "the trial was the beginning";
        }
    }
    EXPECT_EQ(measures, (std::set<std::string>{"path", "collision_rate", "pressure"}));
}

TEST_F(PromisesCommand, IsAskedForSomeBoundsAndErrorsAlone) {
    const auto result = run_carom({"promises", apart, "--error-below", "0.02", "--error-below", "1e-30",
                                   "--measure", "path", "--record", kept});
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_NE(result.output.find("no method is known to reach it"), std::string::npos);
    EXPECT_NE(result.output.find("kept 1 of 2"), std::string::npos);
    const auto promises = record()["promises"];
    ASSERT_EQ(promises.size(), 2);
    EXPECT_EQ(promises[0]["error_below"], 0.02);
    EXPECT_TRUE(promises[1]["chosen"].is_null()) << "never a zero";
    EXPECT_TRUE(promises[1]["promised"].is_null());
}

TEST_F(PromisesCommand, RefusesWhatCannotBe) {
    EXPECT_TRUE(refused(run_carom({"promises", apart, "--error-below", "0"}), 1, {"--error-below", "0"}));
    EXPECT_TRUE(refused(run_carom({"promises", apart, "--measure", "speed"}), 1, {"speed", "pressure"}));
    EXPECT_TRUE(refused(run_carom({"promises", apart, "--record", directory / "no/such"}), 1, {"no/such"}));
    const std::string overlapping = directory.write("over.in", scene_text(tests::overlapping_starts()));
    EXPECT_TRUE(refused(run_carom({"promises", overlapping}), 1, {"overlap", "no exact run"}));
}

} // namespace
} // namespace carom
