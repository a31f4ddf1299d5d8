#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "kernels/scene.hpp"

namespace carom {

/// A trajectory, as `carom run --trajectory` writes it: for each step, from 0 on, a line `step i x y vx vy`
/// for each disc, in any order. Plain text, or compressed by gzip.
class TrajectoryFile {
  public:
    /// Throws InputError if it cannot be opened.
    TrajectoryFile(const std::string& path, std::size_t discs);
    ~TrajectoryFile();
    TrajectoryFile(const TrajectoryFile&) = delete;
    TrajectoryFile& operator=(const TrajectoryFile&) = delete;

    /// The discs at the end of the next step. Throws InputError, with file and line, for what is no line of
    /// that step, for a disc named twice, and if the file ends before.
    std::vector<Disc> next();

    /// Throws InputError if anything but blank lines is left.
    void require_end();

    const std::string& path() const { return path_; }

    /// Significant digits of the longest number read so far: it takes up to 17 to write a double exactly.
    int most_digits() const { return most_digits_; }

  private:
    bool next_line();
    Disc disc_of_line(std::vector<bool>& seen, std::size_t& index);
    [[noreturn]] void refuse(const std::string& what) const;

    std::string path_;
    std::size_t discs_;
    void* file_; ///< zlib's
    std::string line_;
    std::size_t line_number_ = 0;
    int steps_read_ = 0;
    int most_digits_ = 0;
};

} // namespace carom
