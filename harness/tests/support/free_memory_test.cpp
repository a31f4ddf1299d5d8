#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "harness/support/errors.hpp"
#include "harness/support/free_memory.hpp"
#include "harness/tests/temporary_directory.hpp"

namespace carom {
namespace {

namespace fs = std::filesystem;

/// A root with a few files of its own.
class FreeMemory : public testing::Test {
  protected:
    void write(const std::string& path, const std::string& text) const {
        fs::create_directories((root_ / path).parent_path());
        std::ofstream(root_ / path) << text;
    }

    tests::TemporaryDirectory directory_;
    const fs::path root_ = directory_.path();
};

TEST_F(FreeMemory, IsWhatTheSystemHasAvailable) {
    EXPECT_FALSE(available_memory(root_));
    EXPECT_FALSE(free_memory(root_));
    write("proc/meminfo", "MemTotal: 4000 kB\nMemFree: 1 kB\nMemAvailable: 3000 kB\n");
    EXPECT_EQ(available_memory(root_), 3000 * 1024);
    EXPECT_EQ(free_memory(root_), 3000 * 1024);
}

TEST_F(FreeMemory, IsNoMoreThanAnyControlGroupLeaves) {
    write("proc/meminfo", "MemAvailable: 3000 kB\n");
    write("proc/self/cgroup", "1:cpu:/other\n0::/job/step\n");
    write("sys/fs/cgroup/job/step/memory.max", "max\n");
    write("sys/fs/cgroup/job/step/memory.current", "1000\n");
    EXPECT_EQ(free_memory(root_), 3000 * 1024);
    write("sys/fs/cgroup/job/memory.max", "50000\n");
    write("sys/fs/cgroup/job/memory.current", "20000\n");
    EXPECT_EQ(free_memory(root_), 30'000);
    write("sys/fs/cgroup/job/memory.stat", "anon 11000\ninactive_file 5000\nactive_file 3000\nshmem 7\n");
    EXPECT_EQ(free_memory(root_), 38'000);
    write("sys/fs/cgroup/job/memory.current", "90000\n");
    EXPECT_EQ(free_memory(root_), 0);
}

TEST_F(FreeMemory, OfTheTopGroupIsThatOfAContainer) {
    write("proc/self/cgroup", "0::/\n");
    write("sys/fs/cgroup/memory.max", "50000\n");
    write("sys/fs/cgroup/memory.current", "10000\n");
    EXPECT_EQ(free_memory(root_), 40'000);
}

TEST(RequireMemory, RefusesWhatNoMachineHas) {
    EXPECT_NO_THROW(require_memory(1, "a byte"));
    try {
        require_memory(std::numeric_limits<std::int64_t>::max(), "all discs");
        FAIL() << "not refused";
    } catch (const InputError& error) {
        const std::string text = error.what();
        EXPECT_TRUE(text.starts_with("out of memory: found ")) << text;
        EXPECT_TRUE(text.ends_with(" GiB free, expected at least 8.59e+09 GiB for all discs")) << text;
    }
}

} // namespace
} // namespace carom
