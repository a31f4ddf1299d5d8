#include <array>
#include <filesystem>
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
using tests::TemporaryDirectory;

std::string refusal_to_write(const std::string& path) {
    try {
        OutputFile file(path);
        file.write("text");
        file.finish();
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(OutputFile, TakesItsNameWhenFinished) {
    const TemporaryDirectory directory;
    const std::string path = directory / "result";
    OutputFile file(path);
    file.write("one ");
    file.write("");
    file.write("two");
    EXPECT_FALSE(std::filesystem::exists(path));
    file.finish();
    EXPECT_EQ(content_of(path), "one two");
}

TEST(OutputFile, LeavesNothingBesideItsResult) {
    const TemporaryDirectory directory;
    {
        OutputFile file(directory / "result");
        file.write("text");
        file.finish();
    }
    const std::filesystem::directory_iterator entries(directory / "");
    EXPECT_EQ(std::distance(begin(entries), end(entries)), 1);
}

TEST(OutputFile, LeavesNothingUnlessFinished) {
    const TemporaryDirectory directory;
    {
        OutputFile file(directory / "result");
        file.write("text");
        EXPECT_FALSE(directory.empty());
    }
    EXPECT_TRUE(directory.empty());
}

TEST(OutputFile, LeavesTheFileOfThatNameAloneUnlessFinished) {
    const TemporaryDirectory directory;
    const std::string path = directory.write("result", "old");
    {
        OutputFile file(path);
        file.write("new");
    }
    EXPECT_EQ(content_of(path), "old");
    {
        OutputFile file(path);
        file.write("new");
        file.finish();
    }
    EXPECT_EQ(content_of(path), "new");
}

TEST(OutputFile, WritesMoreThanTheSystemTakesAtOnce) {
    const TemporaryDirectory directory;
    std::string text;
    text.resize(20'000'000, 'x');
    OutputFile file(directory / "result");
    file.write(text);
    file.finish();
    EXPECT_EQ(content_of(directory / "result"), text);
}

TEST(OutputFile, SaysWhyItCannotBeWritten) {
    const TemporaryDirectory directory;
    const std::string path = directory / "missing/result";
    EXPECT_EQ(refusal_to_write(path),
              path + ": cannot be written (No such file or directory), expected a writable place with room");
}

TEST(OutputFile, ReplacesNoFolder) {
    const TemporaryDirectory directory;
    const std::string path = directory / "folder";
    std::filesystem::create_directory(path);
    EXPECT_TRUE(refusal_to_write(path).starts_with(path + ": cannot be written (Is a directory)"));
    EXPECT_TRUE(std::filesystem::is_directory(path));
    std::filesystem::remove(path);
    EXPECT_TRUE(directory.empty());
}

TEST(OutputFile, IsRefusedBeforeTheWorkThatItIsFor) {
    const TemporaryDirectory directory;
    EXPECT_THROW(require_writable(directory / "missing/result"), InputError);
    require_writable(directory / "result");
    EXPECT_TRUE(directory.empty());
    const std::string there = directory.write("result", "old");
    require_writable(there);
    EXPECT_EQ(content_of(there), "old");
    const std::string pipe = directory / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    require_writable(pipe); // waits for no reader
}

TEST(OutputFile, ReplacesNoDeviceOrPipe) {
    // As root, a result renamed to /dev/null would take the device's place. A named pipe stands for it here.
    const TemporaryDirectory directory;
    const std::string path = directory / "pipe";
    ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
    const int reader = open(path.c_str(), O_RDONLY | O_NONBLOCK);
    ASSERT_GE(reader, 0);
    {
        OutputFile file(path);
        file.write("result");
        file.finish();
    }
    std::array<char, 16> text{};
    EXPECT_EQ(read(reader, text.data(), text.size()), 6);
    EXPECT_STREQ(text.data(), "result");
    close(reader);
    EXPECT_TRUE(std::filesystem::is_fifo(path));
}

} // namespace
} // namespace carom
