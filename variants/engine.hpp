#pragma once

namespace carom {

/// What takes a simulation from its start to its end.
enum class Engine {
    steps,        ///< the kernel, step by step (kernels/step.hpp), with its policies
    event_driven, ///< from collision to collision (kernels/exact/event_driven.hpp), without a step and
                  ///< without any of the step's policies but the precision
};

} // namespace carom
