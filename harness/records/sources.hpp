#pragma once

#include <map>
#include <string>
#include <tuple>
#include <vector>

#include <nlohmann/json.hpp>
#include <sys/types.h>

namespace carom {

/// The files that make up somebody's program, as they were before it ran.
class Sources {
  public:
    /// `written` are those that the program is known to write itself, each with the hash that stands for it,
    /// whatever it holds now. Throws InputError for a file that cannot be read or is no plain file.
    Sources(const std::vector<std::string>& files, const std::map<std::string, std::string>& written);

    /// Each with its path and its SHA-256 (64 hexadecimal digits), in the order given.
    nlohmann::ordered_json json() const;

    /// Of the one file, or of the hashes of all in a row.
    std::string hash() const;

    /// Those that hold something else by now, the written ones left out: their content is not compared
    /// where size, times and place are what they were.
    std::vector<std::string> changed() const;

  private:
    /// What of a file changes with its content: where it is, its bytes, seconds and nanoseconds of the last
    /// changes of these and of its status; zeroes of what is not there.
    using Stamp = std::tuple<dev_t, ino_t, off_t, time_t, long, time_t, long>;
    struct Source {
        std::string path;
        std::string sha256;
        bool is_written;
        Stamp stamp;
    };
    static Stamp stamp_of(const std::string& path);

    std::vector<Source> sources_;
};

} // namespace carom
