#pragma once

namespace carom {

/// How threads wait for each other at the end of a loop, for the verbs that do not measure: they look out for
/// a moment, then sleep. Left to itself GNU's OpenMP looks out for milliseconds, for a thread that may have
/// been put aside in favour of the very one that looks out: beside other programs a run then takes a hundred
/// times as long. What the user has set (OMP_WAIT_POLICY, GOMP_SPINCOUNT) stays, and so do the verbs that
/// measure.
///
/// It has happened before main (waiting.cpp); this puts the environment back into the state in which that
/// runtime did not find it, or says so if there was no place for the setting. To be called first in main.
void settle_waiting();

} // namespace carom
