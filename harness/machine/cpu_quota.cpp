#include "harness/machine/cpu_quota.hpp"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "harness/machine/machine.hpp"
#include "harness/support/own_cgroup.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts;
    std::istringstream stream(text);
    for (std::string part; std::getline(stream, part, separator);) {
        parts.push_back(part);
    }
    return parts;
}

/// A blank, tab, line break or backslash stands as three octal digits in mountinfo.
std::string unescaped(const std::string& text) {
    std::string result;
    for (std::size_t k = 0; k < text.size(); ++k) {
        const std::string digits = text.substr(k + 1, 3);
        if (text[k] == '\\' && digits.size() == 3 &&
            digits.find_first_not_of("01234567") == std::string::npos && digits[0] < '4') {
            result += static_cast<char>((digits[0] - '0') * 64 + (digits[1] - '0') * 8 + (digits[2] - '0'));
            k += 3;
        } else {
            result += text[k];
        }
    }
    return result;
}

} // namespace

std::vector<CgroupMount> cgroup_mounts(const fs::path& root) {
    std::vector<CgroupMount> mounts;
    std::ifstream file(root / "proc/self/mountinfo");
    for (std::string line; std::getline(file, line);) {
        const std::size_t dash = line.find(" - ");
        if (dash == std::string::npos) {
            continue;
        }
        const auto fields = split(line.substr(0, dash), ' ');
        const auto kind = split(line.substr(dash + 3), ' ');
        if (fields.size() < 5 || kind.empty()) {
            continue;
        }
        if (kind[0] == "cgroup2") {
            mounts.push_back({unescaped(fields[4]), unescaped(fields[3])});
        }
    }
    return mounts;
}

namespace {

/// The groups that are seen at a mount: its top, and those from there down to this process's own. Empty if
/// that one is not below the top.
std::vector<fs::path> groups_at(const fs::path& root, const CgroupMount& mount, const fs::path& own) {
    const fs::path inside = own.lexically_relative(mount.top);
    if (inside.empty() || *inside.begin() == "..") {
        return {};
    }
    std::vector<fs::path> groups{root / mount.place.relative_path()};
    for (const fs::path& part : inside) {
        groups.push_back(groups.back() / part);
    }
    return groups;
}

/// The groups that limit this process, as far as it sees them.
std::vector<fs::path> limiting_groups(const fs::path& root) {
    const auto own = own_cgroup(root);
    std::vector<fs::path> groups;
    std::vector<fs::path> tops;
    for (const CgroupMount& mount : cgroup_mounts(root)) {
        if (own) {
            const auto more = groups_at(root, mount, *own);
            groups.insert(groups.end(), more.begin(), more.end());
            tops.push_back(root / mount.place.relative_path());
        }
    }
    // A container may be told its group by another name than the one that it sees it by, as the top.
    return groups.empty() ? tops : groups;
}

/// What one group allows by itself.
std::optional<double> quota_of(const fs::path& group) {
    const auto numbers = split(first_line(group / "cpu.max").value_or(""), ' ');
    if (numbers.size() != 2) {
        return std::nullopt;
    }
    const auto quota = parse_number<std::int64_t>(numbers[0]);
    const auto period = parse_number<std::int64_t>(numbers[1]);
    return quota && period && *quota > 0 && *period > 0
               ? std::optional(static_cast<double>(*quota) / static_cast<double>(*period))
               : std::nullopt;
}

} // namespace

std::optional<double> read_cpu_quota(const fs::path& root) {
    std::optional<double> least;
    for (const fs::path& group : limiting_groups(root)) {
        if (const auto quota = quota_of(group)) {
            least = std::min(*quota, least.value_or(*quota));
        }
    }
    return least;
}

bool has_unread_cpu_quota(const fs::path& root) {
    std::ifstream file(root / "proc/self/cgroup");
    for (std::string line; std::getline(file, line);) {
        const auto fields = split(line, ':');
        if (fields.size() > 1 && std::ranges::count(split(fields[1], ','), "cpu") > 0) {
            return true;
        }
    }
    return false;
}

} // namespace carom
