#pragma once

namespace carom {

template <class Real> struct Collision;

/// The phases of a time step, in the order in which they run.
enum class Phase { move, bin, find, resolve };

/// Is told what the step does, as it does it. The kernel itself never reads a clock: who profiles does, in
/// here.
///
/// The master calls `phase_begin`, `phase_end`, `sweep_begin` and `sweep_end` outside parallel loops. Each
/// thread calls `loop_begin` when it enters a parallel loop, `iteration` before each of its iterations,
/// `loop_end` when it has none left, and `barrier_end` when all threads are through; `wait_begin` and
/// `wait_end`, before an iteration, where it has to wait for others. Sweeps that run as one are told as one.
class Probe {
  public:
    virtual ~Probe() = default;
    virtual void phase_begin(Phase) = 0;
    virtual void phase_end(Phase) = 0;
    virtual void sweep_begin() = 0;
    virtual void sweep_end() = 0;
    virtual void loop_begin(int thread) = 0;
    virtual void wait_begin(int thread) = 0;
    virtual void wait_end(int thread) = 0;
    virtual void iteration(int thread, int index) = 0;
    virtual void loop_end(int thread) = 0;
    virtual void barrier_end(int thread) = 0;

    /// A profile has no use for single collisions: see LoggingProbe.
    void collided(const Collision<double>& /*collision*/) {}
};

/// The probe of a timed run: is told nothing and costs nothing.
class NoProbe {
  public:
    void phase_begin(Phase) {}
    void phase_end(Phase) {}
    void sweep_begin() {}
    void sweep_end() {}
    void loop_begin(int /*thread*/) {}
    void wait_begin(int /*thread*/) {}
    void wait_end(int /*thread*/) {}
    void iteration(int /*thread*/, int /*index*/) {}
    void loop_end(int /*thread*/) {}
    void collided(const Collision<double>& /*collision*/) {}
};

} // namespace carom
