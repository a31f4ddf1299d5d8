#pragma once

#include <cstdint>
#include <vector>

#include "harness/side_by_side/program_contender.hpp"

namespace carom {

struct Together {
    double slice_seconds = 0.01;
    std::uint64_t seed = 1; ///< of the order of slices and of stretches
};

/// Measures programs beside each other.
///
/// What may be sliced takes turns (slices.hpp). Where nobody says whether a program may be, it runs once
/// undisturbed first. It then has a stretch of its own, by itself, for each of these reasons:
///  - it is idle for more than half of its time, and not for want of a processor: what it waits for goes on
///  while it stands still;
///  - it succeeds undisturbed and fails in slices: a wait that was interrupted, a partner that gave it up;
///  - a run in slices is further from all undisturbed ones than noise explains: by a tenth of the time, or by
///    a twentieth of the time for each second of CPU time, which noise of the machine hardly changes. Then it
///    runs undisturbed again, and all take turns again, up to three times in all: it may be noise, or that
///    it waits for one of the others, which stands still then. Only where no time all of them agree it
///    counts, of each that disagreed.
/// A run that told so and was undisturbed counts; one in slices that agrees counts as well, unless nobody
/// else is left.
///
/// Stretches are in random order, among themselves and with the one of all slices. What has `rounds` runs so
/// often, spread evenly over all of that at random. What times itself within short processes has several
/// rounds after it, each in an order of its own: so many that the longest has had a second, but no more than
/// anyone's `most_rounds`.
///
/// Throws InputError if the system has no room for processes.
std::vector<Measured> measure_together(const std::vector<ProgramContender>& contenders, const Together& how);

} // namespace carom
