#pragma once

#include "harness/verify/rounding.hpp"

namespace carom {

/// The box's walls as a disc meets them along one axis, computed in the variant's own precision.
struct Walls {
    double side;
    double radius;
    Rounding rounding;

    bool touches_low(double position) const { return position - radius <= 0; }
    bool touches_high(double position) const { return rounding(position + radius) >= side; }
    bool touches(double position) const { return touches_low(position) || touches_high(position); }
};

} // namespace carom
