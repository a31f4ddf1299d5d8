#include "harness/records/sources.hpp"

#include <sys/stat.h>

#include "harness/support/errors.hpp"
#include "harness/support/input_file.hpp"
#include "harness/support/sha256.hpp"

namespace carom {
namespace {

/// Whoever opened a pipe to read it would wait for a writer.
std::string hash_of_file(const std::string& path) {
    struct stat status{};
    if (stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode)) {
        throw InputError(path + ": found no plain file, expected one, since it is part of a program");
    }
    return sha256(read_file(path));
}

} // namespace

Sources::Sources(const std::vector<std::string>& files, const std::map<std::string, std::string>& written) {
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

nlohmann::ordered_json Sources::json() const {
    auto json = nlohmann::ordered_json::array();
    for (const Source& source : sources_) {
        json.push_back({{"path", source.path}, {"sha256", source.sha256}});
    }
    return json;
}

std::string Sources::hash() const {
    if (sources_.size() == 1) {
        return sources_.front().sha256;
    }
    std::string all;
    for (const Source& source : sources_) {
        all += source.sha256;
    }
    return sha256(all);
}

std::vector<std::string> Sources::changed() const {
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

Sources::Stamp Sources::stamp_of(const std::string& path) {
    struct stat status{};
    if (stat(path.c_str(), &status) != 0) {
        return {};
    }
    return {status.st_dev,          status.st_ino,         status.st_size,        status.st_mtim.tv_sec,
            status.st_mtim.tv_nsec, status.st_ctim.tv_sec, status.st_ctim.tv_nsec};
}

} // namespace carom
