#include "harness/processes/tree.hpp"

#include <algorithm>
#include <csignal>
#include <vector>

#include <unistd.h>

#include "harness/processes/cgroup.hpp"
#include "harness/processes/descendants.hpp"
#include "harness/support/process_clock.hpp"

namespace carom {
namespace {

class SignalledTree : public Tree {
  public:
    void set_keeper(pid_t keeper) override { keeper_ = keeper; }

    /// What is between vfork and exec cannot stop before its child has gone on, so that nothing is waited for
    /// without a limit, and not at all where one runs as another user. Whoever is found later may have been
    /// started before its parent stood still.
    bool stop(double most_seconds) override {
        const double begin = process_seconds();
        while (true) {
            const std::vector<pid_t> all = descendants_of(keeper_);
            const bool still = std::ranges::all_of(all, stands_still);
            if (still && all == stopped_) {
                return true;
            }
            const bool all_reached = send_signal(all, SIGSTOP).empty();
            stopped_ = all;
            if (!all_reached || process_seconds() - begin > most_seconds) {
                go_on();
                return false;
            }
            usleep(still ? 0 : 50);
        }
    }

    void go_on() override {
        send_signal(descendants_of(keeper_), SIGCONT);
        stopped_.clear();
    }

    void kill() const override { send_signal(descendants_of(keeper_), SIGKILL); }

    std::string name() const override { return "subreaper"; }

  private:
    pid_t keeper_ = 0;
    std::vector<pid_t> stopped_; ///< told to stop, and still there when it was last looked
};

} // namespace

std::unique_ptr<Tree> make_tree(KeptBy kept_by) {
    if (kept_by == KeptBy::whatever_works) {
        if (auto group = Cgroup::make()) {
            return group;
        }
    }
    return std::make_unique<SignalledTree>();
}

} // namespace carom
