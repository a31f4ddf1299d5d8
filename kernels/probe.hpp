#pragma once

#include "scene.hpp"

namespace carom {

/// The phases of a time step, in the order in which they run.
enum class Phase { move, bin, find, resolve };

/// A collision as a simulation has just made it.
template <class Real> struct Collision {
    Real time;                    ///< since the start (exact/event_driven.hpp), or before the end of the step
                                  ///< (Impact::at_contact)
    int sweep;                    ///< Impact::at_contact: of the step, from 0; else 0
    int first;                    ///< the number of a disc
    int second;                   ///< the same; the first one's if it met a wall
    BasicDisc<Real> first_after;  ///< at that time (event-driven), or at the end of the step (at_contact)
    BasicDisc<Real> second_after; ///< likewise

    bool at_wall() const { return first == second; }
    friend bool operator==(const Collision&, const Collision&) = default;
};

/// Is told every collision, after it was made. With Impact::at_contact by any thread; two of one disc are
/// told in the order of their sweeps.
template <class Real> class CollisionLog {
  public:
    virtual ~CollisionLog() = default;
    virtual void collided(const Collision<Real>&) = 0;
};

/// The log of a timed run: is told nothing and costs nothing.
class NoCollisionLog {
  public:
    template <class Real> void collided(const Collision<Real>& /*collision*/) {}
};

/// Is told what the step does, as it does it. The kernel itself never reads a clock: who profiles does, in
/// here.
///
/// The master calls `phase_begin`, `phase_end`, `sweep_begin` and `sweep_end` outside parallel loops. Each
/// thread calls `loop_begin` when it enters a parallel loop, `iteration` before each of its iterations,
/// `loop_end` when it has none left, and `barrier_end` when all threads are through; `wait_begin` and
/// `wait_end`, before an iteration or its last `loop_end`, where it has to wait for others. Sweeps that run
/// as one are told as one.
class Probe {
  public:
    virtual ~Probe() = default;
    virtual void phase_begin(Phase) {}
    virtual void phase_end(Phase) {}
    virtual void sweep_begin() {}
    virtual void sweep_end() {}
    virtual void loop_begin(int /*thread*/) {}
    virtual void wait_begin(int /*thread*/) {}
    virtual void wait_end(int /*thread*/) {}
    virtual void iteration(int /*thread*/, int /*index*/) {}
    virtual void loop_end(int /*thread*/) {}
    virtual void barrier_end(int /*thread*/) {}

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

/// The probe of a run whose collisions at contact are told.
class LoggingProbe : public NoProbe {
  public:
    explicit LoggingProbe(CollisionLog<double>& log) : log_(log) {}

    void barrier_end(int /*thread*/) {}
    void collided(const Collision<double>& collision) { log_.collided(collision); }

  private:
    CollisionLog<double>& log_;
};

} // namespace carom
