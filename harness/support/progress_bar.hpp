#pragma once

#include <string>

namespace carom {

/// A bar with the time left on standard error, if that is a terminal and the work takes more than two
/// seconds.
class ProgressBar {
  public:
    ProgressBar(std::string label, int total);

    /// Is there anybody to show it to?
    bool on_terminal() const { return on_terminal_; }

    /// Shows that `done` of the total are done, ten times a second at most.
    void show(int done);

    /// Wipes the bar from the terminal.
    void clear();

  private:
    std::string label_;
    int total_;
    bool on_terminal_;
    bool shown_ = false;
    double start_;
    double next_;
};

} // namespace carom
