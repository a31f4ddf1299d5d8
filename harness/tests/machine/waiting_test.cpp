#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/scenes/scene_file.hpp"
#include "harness/tests/program.hpp"
#include "harness/tests/temporary_directory.hpp"
#include "kernels/tests/scenes.hpp"

extern "C" [[gnu::weak]] void kmp_set_blocktime(int milliseconds); // NOLINT(readability-*)

namespace carom {
namespace {

/// How GNU's runtime waits in the program, as it says itself.
class Waiting : public testing::Test {
  protected:
    void SetUp() override {
        if (kmp_set_blocktime != nullptr) {
            GTEST_SKIP() << "LLVM's runtime does not say how it waits";
        }
    }

    std::string spins(const std::string& verb, std::vector<std::string> environment = {}) {
        for (const char* name : {"OMP_WAIT_POLICY", "GOMP_SPINCOUNT"}) {
            environment.emplace_back(name);
        }
        environment.emplace_back("OMP_DISPLAY_ENV=verbose");
        const std::string said = tests::run_carom({verb, scene, "--threads", "1"}, environment).error;
        const std::string name = "GOMP_SPINCOUNT = '";
        const auto at = said.find(name);
        return at == std::string::npos
                   ? said
                   : said.substr(at + name.size(), said.find('\'', at + name.size()) - at - name.size());
    }

    tests::TemporaryDirectory directory;
    std::string scene = directory.write("scene.in", scene_text(tests::corner()));
};

TEST_F(Waiting, IsShortForVerbsThatDoNotMeasure) {
    for (const char* verb : {"run", "check"}) {
        EXPECT_EQ(spins(verb), "2000") << verb;
    }
}

TEST_F(Waiting, IsTheRuntimesOwnForVerbsThatMeasure) { EXPECT_EQ(spins("profile"), "300000"); }

TEST_F(Waiting, IsTheUsersIfHeSaysSo) {
    EXPECT_EQ(spins("run", {"GOMP_SPINCOUNT=77"}), "77");
    EXPECT_EQ(spins("run", {"OMP_WAIT_POLICY=passive"}), "0");
}

} // namespace
} // namespace carom
