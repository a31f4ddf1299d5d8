#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/counters/cachegrind.hpp"
#include "harness/counters/cachegrind_output.hpp"
#include "harness/tests/counters/simulated_scene.hpp"
#include "harness/tests/temporary_directory.hpp"

namespace carom {
namespace {

/// An environment variable that has its old value back afterwards.
class Setting {
  public:
    Setting(const char* name, const std::string& value) : name_(name) {
        if (const char* old = std::getenv(name)) {
            old_ = old;
        }
        setenv(name, value.c_str(), 1);
    }
    ~Setting() {
        if (old_) {
            setenv(name_, old_->c_str(), 1);
        } else {
            unsetenv(name_);
        }
    }
    Setting(const Setting&) = delete;
    Setting& operator=(const Setting&) = delete;

  private:
    const char* name_;
    std::optional<std::string> old_;
};

/// The reason that all counts have for having no value.
std::string only_reason(const std::vector<CounterValue>& rows) {
    EXPECT_EQ(rows.size(), simulated_counts().size());
    for (const CounterValue& row : rows) {
        EXPECT_FALSE(row.value.has_value());
        EXPECT_EQ(row.source, "cachegrind");
        EXPECT_EQ(row.reason, rows.front().reason);
        EXPECT_NE(row.remedy, "");
    }
    return rows.front().reason;
}

class SimulatedCounters : public testing::Test {
  protected:
    void SetUp() override {
        if (const std::string obstacle = tests::no_simulation(); !obstacle.empty()) {
            GTEST_SKIP() << obstacle;
        }
    }
};

TEST_F(SimulatedCounters, AProgramThatFailsIsTheReason) {
    const tests::TemporaryDirectory directory;
    const std::string program =
        directory.write("failing", "#!/bin/sh\necho 'carom: something went wrong' >&2\nexit 3\n");
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    const std::string reason =
        only_reason(simulate_counters(tests::simulated_scene(), "published", {}, 1, program));
    EXPECT_NE(reason.find("exit code 3: carom: something went wrong"), std::string::npos) << reason;
}

TEST_F(SimulatedCounters, AnInstructionThatValgrindDoesNotKnowIsTheReason) {
    const tests::TemporaryDirectory directory;
    const std::string program = directory.write("dying", "#!/bin/sh\nkill -ILL $$\n");
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    const std::string reason =
        only_reason(simulate_counters(tests::simulated_scene(), "published", {}, 1, program));
    EXPECT_NE(reason.find("does not know an instruction of this program"), std::string::npos) << reason;
}

TEST_F(SimulatedCounters, LeaveNoFilesBehind) {
    const tests::TemporaryDirectory directory;
    const Setting temporary("TMPDIR", directory / "");
    tests::simulate("published", 1);
    EXPECT_TRUE(directory.empty());
}

TEST(SimulatedCountersWithoutValgrind, SayThatItIsMissing) {
    const tests::TemporaryDirectory directory;
    const Setting path("PATH", directory / "");
    EXPECT_EQ(only_reason(simulate_counters(tests::simulated_scene(), "published", {}, 1, CAROM_PROGRAM)),
              "valgrind is not on PATH");
}

} // namespace
} // namespace carom
