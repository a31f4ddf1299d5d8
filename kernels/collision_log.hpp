#pragma once

#include "probe.hpp"
#include "scene.hpp"

namespace carom {

/// A collision as a simulation has just made it.
template <class Real> struct Collision {
    Real time; ///< since the start (Impact::event_driven), or before the end of the step (Impact::at_contact)
    int sweep; ///< Impact::at_contact: of the step, from 0; else 0
    int first; ///< the number of a disc
    int second;                   ///< the same; the first one's if it met a wall
    BasicDisc<Real> first_after;  ///< at that time (event_driven), or at the end of the step (at_contact)
    BasicDisc<Real> second_after; ///< likewise

    bool at_wall() const { return first == second; }
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
