#include <array>
#include <filesystem>
#include <iterator>
#include <string>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "harness/support/errors.hpp"
#include "harness/support/output_file.hpp"
#include "harness/tests/temporary_directory.hpp"

namespace carom {
namespace {

using tests::content_of;

class OutputFileTest : public testing::Test {
  protected:
    static std::string refusal_to_write(const std::string& path) {
        try {
            OutputFile file(path);
            file.write("text");
            file.finish();
        } catch (const InputError& error) {
            return error.what();
        }
        return "accepted";
    }

    tests::TemporaryDirectory directory;
    const std::string path = directory / "result";
};

TEST_F(OutputFileTest, TakesItsNameWhenFinishedAndLeavesNothingElse) {
    const std::string more_than_the_system_takes_at_once(20'000'000, 'x');
    OutputFile file(path);
    file.write("one ");
    file.write("");
    file.write(more_than_the_system_takes_at_once);
    EXPECT_FALSE(std::filesystem::exists(path));
    file.finish();
    EXPECT_EQ(content_of(path), "one " + more_than_the_system_takes_at_once);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(directory.path()), {}), 1);
}

TEST_F(OutputFileTest, LeavesAllAsItWasUnlessFinished) {
    {
        OutputFile file(path);
        file.write("text");
        EXPECT_FALSE(directory.empty());
    }
    EXPECT_TRUE(directory.empty());
    directory.write("result", "old");
    {
        OutputFile file(path);
        file.write("new");
    }
    EXPECT_EQ(content_of(path), "old");
    EXPECT_EQ(refusal_to_write(path), "accepted");
    EXPECT_EQ(content_of(path), "text");
}

TEST_F(OutputFileTest, ReplacesNoFolder) {
    std::filesystem::create_directory(path);
    EXPECT_TRUE(refusal_to_write(path).starts_with(path + ": cannot be written (Is a directory)"));
    EXPECT_TRUE(std::filesystem::is_directory(path));
}

TEST_F(OutputFileTest, IsRefusedBeforeTheWorkThatItIsFor) {
    EXPECT_THROW(require_writable(directory / "missing/result"), InputError);
    require_writable(path);
    EXPECT_TRUE(directory.empty());
    directory.write("result", "old");
    require_writable(path);
    EXPECT_EQ(content_of(path), "old");
}

TEST_F(OutputFileTest, ReplacesNoDeviceOrPipe) {
    // As root, a result renamed to /dev/null would take the device's place. A named pipe stands for it here.
    ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
    require_writable(path); // waits for no reader
    const int reader = open(path.c_str(), O_RDONLY | O_NONBLOCK);
    ASSERT_GE(reader, 0);
    EXPECT_EQ(refusal_to_write(path), "accepted");
    std::array<char, 16> text{};
    EXPECT_EQ(read(reader, text.data(), text.size()), 4);
    EXPECT_STREQ(text.data(), "text");
    close(reader);
    EXPECT_TRUE(std::filesystem::is_fifo(path));
}

} // namespace
} // namespace carom
