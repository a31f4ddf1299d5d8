#include "harness/support/nearest.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace carom {
namespace {

std::size_t edit_distance(std::string_view one, std::string_view two) {
    std::vector<std::size_t> row(two.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (const char letter : one) {
        std::size_t diagonal = row[0]++;
        for (std::size_t k = 0; k < two.size(); ++k) {
            const std::size_t replaced = diagonal + (letter != two[k]);
            diagonal = row[k + 1];
            row[k + 1] = std::min({diagonal + 1, row[k] + 1, replaced});
        }
    }
    return row.back();
}

} // namespace

std::string nearest(std::string_view found, const std::vector<std::string>& names) {
    return *std::ranges::min_element(names, {},
                                     [found](const std::string& name) { return edit_distance(found, name); });
}

std::string did_you_mean(std::string_view found, const std::vector<std::string>& names) {
    if (names.empty()) {
        return "";
    }
    const std::string name = nearest(found, names);
    const std::size_t far = std::max<std::size_t>(1, found.size() / 3);
    return edit_distance(found, name) <= far ? "; did you mean '" + name + "'?" : "";
}

} // namespace carom
