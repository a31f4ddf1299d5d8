#pragma once

namespace carom {

/// While it lives, nothing that is written to standard error is seen. For calls of libraries that print there
/// what the program tells in its own words, or that is no matter to its user; nobody else may print
/// meanwhile.
class Silence {
  public:
    Silence();
    ~Silence();
    Silence(const Silence&) = delete;
    Silence& operator=(const Silence&) = delete;

  private:
    int standard_error_ = -1; ///< a copy, or -1 if none could be made
};

} // namespace carom
