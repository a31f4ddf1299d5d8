#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "kernels/parallel_for.hpp"
#include "kernels/policies.hpp"
#include "kernels/probe.hpp"

namespace carom {

inline constexpr std::size_t phase_count = 4;

/// What one thread did in one phase, summed over all steps.
struct ThreadWork {
    double busy_seconds = 0; ///< in iterations of parallel loops; for the master also in serial code
    double waiting_seconds =
        0; ///< at barriers, for other iterations or any, and while the master runs serial code
    std::int64_t iterations = 0;
    std::int64_t chunks = 0;
    std::int64_t loops = 0;
};

struct PhaseTime {
    double wall_seconds = 0;
    double serial_seconds = 0; ///< of it, outside parallel loops
};

/// A stretch of time on one thread, for the timeline. Seconds since the profile began.
struct Span {
    enum class Kind { phase, sweep, loop, wait, chunk };
    Kind kind;
    Phase phase;
    double begin;
    double end;
    std::int64_t first = 0; ///< of a chunk: its first iteration
    std::int64_t count = 0; ///< of a chunk: how many
};

/// What of the timeline to keep. A profiler that has kept `most_spans` leaves out the rest and counts it.
struct TimelineOptions {
    bool spans = false;
    bool chunks = false;
    std::size_t most_spans = 300'000;
};

/// A probe that times phases, loops and barriers on every thread and counts iterations and chunks.
///
/// A chunk begins where a thread's iterations are not consecutive, and, where the schedule fixes the chunk
/// (static or dynamic), at each multiple of it. Under a guided schedule chunks that one thread takes one
/// right after another count as one: OpenMP does not tell where they meet.
class Profiler final : public Probe {
  public:
    /// `policies` and `tuning` tell the chunks of each phase's loops.
    Profiler(const Policies& policies, const Tuning& tuning, TimelineOptions timeline);

    void phase_begin(Phase phase) override;
    void phase_end(Phase phase) override;
    void sweep_begin() override;
    void sweep_end() override;
    void loop_begin(int thread) override;
    void wait_begin(int thread) override;
    void wait_end(int thread) override;
    void iteration(int thread, int index) override;
    void loop_end(int thread) override;
    void barrier_end(int thread) override;

    int threads() const { return static_cast<int>(tracks_.size()); }
    const PhaseTime& phase_time(Phase phase) const { return phases_[static_cast<std::size_t>(phase)]; }
    const ThreadWork& work(Phase phase, int thread) const;

    /// The spans of one thread, in the order in which they ended.
    const std::vector<Span>& spans(int thread) const;
    std::size_t spans_left_out() const;

  private:
    /// What one thread writes; a cache line apart from the others'.
    struct alignas(cache_line) Track {
        std::array<ThreadWork, phase_count> work;
        std::vector<Span> spans;
        std::size_t left_out = 0;
        double last_event = 0; ///< the end of the last barrier, or the beginning of the phase
        double loop_begin = 0;
        double loop_end = 0;
        double wait_begin = 0;
        double waited = 0; ///< in the loop, for other iterations
        double chunk_begin = 0;
        std::int64_t chunk_first = 0;
        std::int64_t next_index = -1;
        std::int64_t iterations_before = 0; ///< the loop, in this phase
    };

    double now() const;
    Track& track(int thread) { return tracks_[static_cast<std::size_t>(thread)]; }
    ThreadWork& current(Track& track) { return track.work[static_cast<std::size_t>(phase_)]; }
    void keep(Track& track, const Span& span) const;
    void keep_chunk(Track& track, double end);
    void note_gap(int thread, double until);

    std::vector<Track> tracks_;
    std::array<PhaseTime, phase_count> phases_{};
    std::array<std::optional<int>, phase_count> fixed_chunk_;
    TimelineOptions timeline_;
    std::size_t most_spans_per_thread_;
    Phase phase_ = Phase::move;
    double phase_begin_ = 0;
    double sweep_begin_ = 0;
    double start_ = 0;
};

} // namespace carom
