#include "harness/verify/trajectory.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include <sys/stat.h>
#include <zlib.h>

#include "harness/support/errors.hpp"
#include "harness/support/format.hpp"
#include "harness/support/text.hpp"
#include "harness/verify/disc_states.hpp"
#include "kernels/scene.hpp"

namespace carom {
namespace {

constexpr int most_characters = 1024;
constexpr unsigned buffer_bytes = 1U << 20U;

constexpr std::array<const char*, 6> columns{"step", "i", "x", "y", "vx", "vy"};

int digits_of(std::string_view number) {
    const auto mantissa = number.substr(0, number.find_first_of("eE"));
    const auto first = mantissa.find_first_of("123456789");
    return first == std::string_view::npos
               ? 0
               : static_cast<int>(std::count_if(mantissa.begin() + static_cast<std::ptrdiff_t>(first),
                                                mantissa.end(),
                                                [](unsigned char c) { return std::isdigit(c) != 0; }));
}

bool is_folder(const std::string& path) {
    struct stat status{};
    return stat(path.c_str(), &status) == 0 && S_ISDIR(status.st_mode);
}

/// A trajectory, as `carom run --trajectory` writes it: for each step, from 0 on, a line `step i x y vx vy`
/// for each disc, in any order. Plain text, or compressed by gzip.
class TrajectoryFile {
  public:
    /// Throws InputError if it cannot be opened.
    TrajectoryFile(const std::string& path, std::size_t discs)
        : path_(path), discs_(discs), file_(is_folder(path) ? nullptr : gzopen(path.c_str(), "rb")) {
        if (file_ == nullptr) {
            const char* reason = is_folder(path) ? "is a folder" : std::strerror(errno);
            throw InputError(path + ": cannot be read (" + reason + "), expected a trajectory");
        }
        gzbuffer(file_, buffer_bytes);
    }

    ~TrajectoryFile() { gzclose(file_); }

    TrajectoryFile(const TrajectoryFile&) = delete;
    TrajectoryFile& operator=(const TrajectoryFile&) = delete;

    /// The discs at the end of the next step. Throws InputError, with file and line, for what is no line of
    /// that step, for a disc named twice, and if the file ends before.
    std::vector<Disc> next() {
        std::vector<Disc> discs(discs_);
        std::vector<bool> seen(discs_, false);
        for (std::size_t read = 0; read < discs_; ++read) {
            if (!next_line()) {
                refuse("the trajectory ends with " + counted(read, "disc") + " of step " +
                       std::to_string(steps_read_) + ", expected " + std::to_string(discs_));
            }
            std::size_t index = 0;
            const Disc disc = disc_of_line(seen, index);
            discs[index] = disc;
        }
        ++steps_read_;
        return discs;
    }

    /// Throws InputError if anything but blank lines is left.
    void require_end() {
        if (next_line()) {
            refuse("found '" + line_ + "' after the last step, " + std::to_string(steps_read_ - 1) +
                   ", expected the end of the file");
        }
    }

    /// Significant digits of the longest number read so far: it takes up to 17 to write a double exactly.
    int most_digits() const { return most_digits_; }

  private:
    /// Goes on to the next line that is not blank; false if there is none.
    bool next_line() {
        std::array<char, most_characters> buffer;
        while (gzgets(file_, buffer.data(), most_characters) != nullptr) {
            ++line_number_;
            line_ = buffer.data();
            const bool is_whole = !line_.empty() && line_.back() == '\n';
            if (!is_whole && gzeof(file_) == 0) {
                refuse("found a line of more than " + std::to_string(most_characters - 2) +
                       " characters, expected `step i x y vx vy`");
            }
            if (is_whole) {
                line_.pop_back();
            }
            if (line_.find_first_not_of(" \t\r") != std::string::npos) {
                return true;
            }
        }
        int error = Z_OK;
        const char* said = gzerror(file_, &error);
        if (error != Z_OK && error != Z_STREAM_END) {
            refuse(std::string("cannot be read on (") + (error == Z_ERRNO ? std::strerror(errno) : said) +
                   ")");
        }
        return false;
    }

    Disc disc_of_line(std::vector<bool>& seen, std::size_t& index) {
        std::vector<std::string_view> words;
        std::string_view rest = line_;
        for (auto word = take_word(rest); !word.empty(); word = take_word(rest)) {
            words.push_back(word);
        }
        if (words.size() != columns.size()) {
            refuse("found " + counted(words.size(), "word") + ", expected 6: step i x y vx vy");
        }
        const auto refuse_word = [&](std::size_t k, const std::string& expected) {
            refuse(std::string(columns[k]) + ": found '" + std::string(words[k]) + "', expected " + expected);
        };
        const auto step = parse_number<int>(words[0]);
        if (!step || *step != steps_read_) {
            refuse_word(0, std::to_string(steps_read_));
        }
        const auto number = parse_number<std::size_t>(words[1]);
        if (!number || *number >= discs_) {
            refuse_word(1, "a whole number from 0 to " + std::to_string(discs_ - 1));
        }
        if (seen[*number]) {
            refuse("i: found disc " + std::to_string(*number) + " twice in step " +
                   std::to_string(steps_read_) + ", expected each once");
        }
        index = *number;
        seen[index] = true;
        std::array<double, 4> values{};
        for (std::size_t k = 0; k < values.size(); ++k) {
            const std::string_view word = words[k + 2];
            const auto value = parse_number<double>(word);
            if (!value || !std::isfinite(*value)) {
                refuse_word(k + 2, "a finite number");
            }
            values[k] = *value;
            most_digits_ = std::max(most_digits_, digits_of(word));
        }
        return {values[0], values[1], values[2], values[3]};
    }

    [[noreturn]] void refuse(const std::string& what) const {
        throw InputError(path_ + ":" + std::to_string(line_number_) + ": " + what);
    }

    std::string path_;
    std::size_t discs_;
    gzFile file_;
    std::string line_;
    std::size_t line_number_ = 0;
    int steps_read_ = 0;
    int most_digits_ = 0;
};

/// Of doubles, written in decimal.
constexpr int exact_digits = 17;
constexpr int surely_rounded_digits = 15;

void require_start(const Scene& scene, const std::vector<Disc>& discs, const std::string& path) {
    for (std::size_t i = 0; i < discs.size(); ++i) {
        if (discs[i] != scene.discs[i]) {
            throw InputError(path + format(": begins with disc %zu at %s, expected the scene's %s", i,
                                           state_text(discs[i]).c_str(), state_text(scene.discs[i]).c_str()));
        }
    }
}

std::vector<Disc> rounded(std::vector<Disc> discs, const Rounding& rounding) {
    for (Disc& disc : discs) {
        disc = {rounding(disc.x), rounding(disc.y), rounding(disc.vx), rounding(disc.vy)};
    }
    return discs;
}

} // namespace

CheckedTrajectory check_trajectory(const Scene& scene, const std::string& path, const Checker& checker,
                                   const Rounding& rounding) {
    TrajectoryFile file(path, scene.discs.size());
    const std::vector<Disc> start = file.next();
    require_start(scene, start, path);
    CheckedTrajectory checked{.discs = rounded(start, rounding), .violation = std::nullopt};
    for (int step = 1; step <= scene.steps; ++step) {
        std::vector<Disc> after = file.next();
        if (const auto violation = checker.step(checked.discs, after)) {
            checked.violation = format("step %d: ", step) + *violation;
            if (file.most_digits() <= surely_rounded_digits) {
                *checked.violation += format(" (no number of the file has more than %d digits; it takes %d)",
                                             file.most_digits(), exact_digits);
            }
            return checked;
        }
        checked.discs = std::move(after);
    }
    file.require_end();
    return checked;
}

} // namespace carom
