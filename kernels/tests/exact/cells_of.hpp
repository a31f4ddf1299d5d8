#pragma once

#include "kernels/exact/event_cells.hpp"
#include "kernels/scene.hpp"

namespace carom::tests {

/// The cells of a whole scene, empty.
inline EventCells<double> cells_of(const Scene& scene) {
    return {{.left = 0, .bottom = 0, .width = scene.side, .height = scene.side},
            scene.discs.size(),
            scene.radius};
}

} // namespace carom::tests
