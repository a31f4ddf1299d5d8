#include "harness/scenes/placement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "harness/support/errors.hpp"
#include "harness/support/format.hpp"

namespace carom {
namespace {

double area_fraction_of(int count, double side, double radius) {
    return count * std::numbers::pi * (radius / side) * (radius / side);
}

/// The centres placed so far, by cells of at least 2r: what a centre overlaps lies in the cells around it.
class PlacedCentres {
  public:
    PlacedCentres(int count, double side, double radius) : reach_squared_((2 * radius) * (2 * radius)) {
        // Cells a little wider than 2r: the product that picks a cell is rounded.
        const double widest = side / (2 * radius * (1 + 1e-9));
        const double most = std::min(widest, std::sqrt(static_cast<double>(count)) + 1);
        cells_per_side_ = static_cast<int>(std::max(std::floor(most), 1.0));
        per_length_ = cells_per_side_ / side;
        cells_.resize(static_cast<std::size_t>(cells_per_side_) * static_cast<std::size_t>(cells_per_side_));
    }

    bool overlaps(const Point& centre) const {
        const int row = cell_along(centre.y);
        const int column = cell_along(centre.x);
        for (int k = std::max(row - 1, 0); k <= std::min(row + 1, cells_per_side_ - 1); ++k) {
            for (int l = std::max(column - 1, 0); l <= std::min(column + 1, cells_per_side_ - 1); ++l) {
                const auto near = [&](const Point& other) {
                    const double dx = other.x - centre.x;
                    const double dy = other.y - centre.y;
                    return dx * dx + dy * dy <= reach_squared_;
                };
                if (std::ranges::any_of(cells_[cell(k, l)], near)) {
                    return true;
                }
            }
        }
        return false;
    }

    void insert(const Point& centre) {
        cells_[cell(cell_along(centre.y), cell_along(centre.x))].push_back(centre);
    }

  private:
    std::size_t cell(int row, int column) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(cells_per_side_) +
               static_cast<std::size_t>(column);
    }
    int cell_along(double position) const {
        return std::clamp(static_cast<int>(position * per_length_), 0, cells_per_side_ - 1);
    }

    double reach_squared_;
    double per_length_ = 0;
    int cells_per_side_ = 1;
    std::vector<std::vector<Point>> cells_;
};

/// Rows of `columns` sites each, every other row shifted by half a spacing.
struct Lattice {
    int rows = 1;
    int columns = 1;
    double nearest = 0; ///< least distance of two sites, in a box whose centres span a square of side 1
};

/// The lattice of at least `count` sites whose sites are furthest apart.
Lattice widest_lattice(int count) {
    Lattice best;
    const int most_columns = static_cast<int>(2 * std::sqrt(static_cast<double>(count))) + 2;
    for (int columns = 1; columns <= std::min(most_columns, count); ++columns) {
        const int rows = (count + columns - 1) / columns;
        const double along = 1 / (columns - 0.5);
        const double up = rows > 1 ? 1.0 / (rows - 1) : std::numeric_limits<double>::infinity();
        const double nearest = std::min({along, std::hypot(along / 2, up), 2 * up});
        if (nearest > best.nearest) {
            best = {.rows = rows, .columns = columns, .nearest = nearest};
        }
    }
    return best;
}

/// Each disc may be moved by g in any direction where neighbours are 2r + 2g apart and the walls r + g away:
/// q (L - 2r - 2g) = 2r + 2g with q the nearest distance in a square of side 1.
double free_distance(const Lattice& lattice, double side, double radius) {
    const double q = lattice.nearest;
    return (q * (side - 2 * radius) - 2 * radius) / (2 * (1 + q));
}

int most_on_a_lattice(int count, double side, double radius) {
    int fit = 1;
    for (int too_many = count; too_many - fit > 1;) {
        const int middle = fit + (too_many - fit) / 2;
        (free_distance(widest_lattice(middle), side, radius) > 0 ? fit : too_many) = middle;
    }
    return fit;
}

} // namespace

std::vector<Point> random_sequential_centres(int count, double side, double radius, RandomNumbers& random,
                                             std::int64_t trials_per_disc) {
    PlacedCentres placed(count, side, radius);
    std::vector<Point> centres;
    centres.reserve(static_cast<std::size_t>(count));
    const std::int64_t most_trials = trials_per_disc * count;
    for (std::int64_t trial = 0; static_cast<int>(centres.size()) < count; ++trial) {
        if (trial == most_trials) {
            const int reached = static_cast<int>(centres.size());
            throw InputError(format("--placement random: found room for %d of %d discs in %lld trials (area "
                                    "fraction %.4f), expected an area fraction below its limit, 0.547 in a "
                                    "large box; --placement lattice goes further",
                                    reached, count, static_cast<long long>(most_trials),
                                    area_fraction_of(reached, side, radius)));
        }
        const double x = random.uniform(radius, side - radius);
        const Point centre{x, random.uniform(radius, side - radius)};
        if (!placed.overlaps(centre)) {
            placed.insert(centre);
            centres.push_back(centre);
        }
    }
    return centres;
}

std::vector<Point> lattice_centres(int count, double side, double radius, RandomNumbers& random) {
    if (count == 0) {
        return {};
    }
    const Lattice lattice = widest_lattice(count);
    const double free = count == 1 ? side / 2 - radius : free_distance(lattice, side, radius);
    if (!(free > 0)) {
        const int fit = most_on_a_lattice(count, side, radius);
        throw InputError(format("--placement lattice: found %d discs (area fraction %.4f), expected at most "
                                "%d (area fraction %.4f), which fit into such a box on a hexagonal lattice",
                                count, area_fraction_of(count, side, radius), fit,
                                area_fraction_of(fit, side, radius)));
    }
    const double low = radius + free;
    const double width = side - 2 * low;
    const double along = width / (lattice.columns - 0.5);
    const double up = lattice.rows > 1 ? width / (lattice.rows - 1) : 0;
    const std::int64_t sites = std::int64_t{lattice.rows} * lattice.columns;
    // A little less than the gap, so that rounding makes no overlap.
    const double jitter = free * (1 - 0x1p-20);
    std::vector<Point> centres;
    centres.reserve(static_cast<std::size_t>(count));
    for (std::int64_t i = 0; i < count; ++i) {
        const std::int64_t site = i * sites / count;
        const auto row = site / lattice.columns;
        const auto column = static_cast<double>(site % lattice.columns) + (row % 2 == 0 ? 0.0 : 0.5);
        const Point moved = random.in_unit_circle();
        centres.push_back({low + along * column + jitter * moved.x,
                           low + up * static_cast<double>(row) + jitter * moved.y});
    }
    return centres;
}

} // namespace carom
