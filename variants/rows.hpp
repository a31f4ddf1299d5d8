#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "kernels/policies.hpp"

// How the rows of the table are written.

namespace carom {

template <std::size_t count> constexpr auto rows(const Policies (&row)[count]) { return std::to_array(row); }

/// The cross product of one combination with the values of one axis.
template <class Value, class... Values>
constexpr auto vary(Policies base, Value Policies::* axis, Values... values) {
    std::array<Policies, sizeof...(Values)> rows{};
    std::size_t row = 0;
    ((rows[row] = base, rows[row++].*axis = values), ...);
    return rows;
}

template <std::size_t... sizes> constexpr auto concatenate(const std::array<Policies, sizes>&... parts) {
    std::array<Policies, (sizes + ...)> rows{};
    auto next = rows.begin();
    ((next = std::copy(parts.begin(), parts.end(), next)), ...);
    return rows;
}

/// One policy changed to one value.
template <class Value> struct Flip {
    Value Policies::* axis;
    Value value;
};

template <class Value> constexpr Flip<Value> flip(Value Policies::* axis, Value value) {
    return {axis, value};
}

/// A ladder from the defaults up: each rung is the one before with one policy flipped.
template <class... Values> constexpr auto climb(Flip<Values>... flips) {
    std::array<Policies, sizeof...(Values)> rungs{};
    Policies now;
    std::size_t rung = 0;
    ((now.*flips.axis = flips.value, rungs[rung++] = now), ...);
    return rungs;
}

} // namespace carom
