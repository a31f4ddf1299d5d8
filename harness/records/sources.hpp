#pragma once

#include <map>
#include <string>
#include <tuple>
#include <vector>

#include <nlohmann/json.hpp>
#include <sys/stat.h>
#include <sys/types.h>

#include "harness/support/errors.hpp"
#include "harness/support/input_file.hpp"
#include "harness/support/sha256.hpp"

namespace carom {

/// The files that make up somebody's program, as they were before it ran.
class Sources {
  public:
    /// `written` are those that the program is known to write itself, each with the hash that stands for it,
    /// whatever it holds now. Throws InputError for a file that cannot be read or is no plain file.
    Sources(const std::vector<std::string>& files, const std::map<std::string, std::string>& written) {
        for (const std::string& file : files) {
            const auto known = written.find(file);
            const bool is_written = known != written.end();
            const Stamp stamp = stamp_of(file);
            sources_.push_back({.path = file,
                                .sha256 = is_written ? known->second : hash_of_file(file),
                                .is_written = is_written,
                                .stamp = stamp});
        }
    }

    /// Each with its path and its SHA-256 (64 hexadecimal digits), in the order given.
    nlohmann::ordered_json json() const {
        auto json = nlohmann::ordered_json::array();
        for (const Source& source : sources_) {
            json.push_back({{"path", source.path}, {"sha256", source.sha256}});
        }
        return json;
    }

    /// Of the one file, or of the hashes of all in a row.
    std::string hash() const {
        if (sources_.size() == 1) {
            return sources_.front().sha256;
        }
        std::string all;
        for (const Source& source : sources_) {
            all += source.sha256;
        }
        return sha256(all);
    }

    /// Those that hold something else by now, the written ones left out: their content is not compared
    /// where size, times and place are what they were.
    std::vector<std::string> changed() const {
        std::vector<std::string> changed;
        for (const Source& source : sources_) {
            if (source.is_written || stamp_of(source.path) == source.stamp) {
                continue;
            }
            try {
                if (hash_of_file(source.path) == source.sha256) {
                    continue;
                }
            } catch (const InputError&) {
                // It is gone, which is a change.
            }
            changed.push_back(source.path);
        }
        return changed;
    }

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

    /// Whoever opened a pipe to read it would wait for a writer.
    static std::string hash_of_file(const std::string& path) {
        struct stat status{};
        if (stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode)) {
            throw InputError(path + ": found no plain file, expected one, since it is part of a program");
        }
        return sha256(read_file(path));
    }

    static Stamp stamp_of(const std::string& path) {
        struct stat status{};
        if (stat(path.c_str(), &status) != 0) {
            return {};
        }
        return {status.st_dev,          status.st_ino,         status.st_size,        status.st_mtim.tv_sec,
                status.st_mtim.tv_nsec, status.st_ctim.tv_sec, status.st_ctim.tv_nsec};
    }

    std::vector<Source> sources_;
};

} // namespace carom
