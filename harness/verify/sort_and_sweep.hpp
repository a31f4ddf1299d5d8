#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <vector>

namespace carom {

/// A rectangle with sides along the axes.
struct Extent {
    double low_x;
    double high_x;
    double low_y;
    double high_y;
};

/// `body(one, two)` for the indices of any two extents that meet, each two once. The search of all checkers,
/// which shares nothing with the kernels': extents are sorted by rows of about twice their height, and by
/// where they begin in these, and swept, O(N log N). Beyond 2^40 rows from the origin one row takes all.
template <class Body> void for_each_meeting(const std::vector<Extent>& extents, const Body& body) {
    struct InRow {
        double row;
        double first_row; ///< of the extent, which may lie in several
        std::size_t extent;
    };
    double sum = 0;
    double highest = 0;
    for (const Extent& one : extents) {
        sum += one.high_y - one.low_y;
        highest = std::max(highest, one.high_y - one.low_y);
    }
    const double height = std::max(2 * sum / static_cast<double>(extents.size()), highest / 64);
    const auto row_of = [&](double y) { return std::clamp(std::floor(y / height), -0x1p40, 0x1p40); };
    std::vector<InRow> ways;
    for (std::size_t i = 0; i < extents.size(); ++i) {
        const double first = row_of(extents[i].low_y);
        for (double row = first; row <= row_of(extents[i].high_y); ++row) {
            ways.push_back({row, first, i});
        }
    }
    std::ranges::sort(ways, {}, [&](const InRow& one) {
        return std::tuple(one.row, extents[one.extent].low_x, one.extent);
    });
    for (auto one = ways.begin(); one != ways.end(); ++one) {
        const Extent& here = extents[one->extent];
        for (auto two = one + 1; two != ways.end() && two->row == one->row; ++two) {
            const Extent& there = extents[two->extent];
            if (there.low_x > here.high_x) {
                break;
            }
            if (there.low_y <= here.high_y && here.low_y <= there.high_y &&
                std::max(one->first_row, two->first_row) == one->row) {
                body(one->extent, two->extent);
            }
        }
    }
}

} // namespace carom
