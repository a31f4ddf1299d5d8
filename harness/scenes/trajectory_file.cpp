#include "harness/scenes/trajectory_file.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <string_view>

#include <sys/stat.h>
#include <zlib.h>

#include "harness/support/errors.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

constexpr int most_characters = 1024;
constexpr unsigned buffer_bytes = 1U << 20U;

constexpr std::array<const char*, 6> columns{"step", "i", "x", "y", "vx", "vy"};

gzFile gz(void* file) { return static_cast<gzFile>(file); }

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

} // namespace

TrajectoryFile::TrajectoryFile(const std::string& path, std::size_t discs)
    : path_(path), discs_(discs), file_(is_folder(path) ? nullptr : gzopen(path.c_str(), "rb")) {
    if (file_ == nullptr) {
        const char* reason = is_folder(path) ? "is a folder" : std::strerror(errno);
        throw InputError(path + ": cannot be read (" + reason + "), expected a trajectory");
    }
    gzbuffer(gz(file_), buffer_bytes);
}

TrajectoryFile::~TrajectoryFile() { gzclose(gz(file_)); }

std::vector<Disc> TrajectoryFile::next() {
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

void TrajectoryFile::require_end() {
    if (next_line()) {
        refuse("found '" + line_ + "' after the last step, " + std::to_string(steps_read_ - 1) +
               ", expected the end of the file");
    }
}

/// Goes on to the next line that is not blank; false if there is none.
bool TrajectoryFile::next_line() {
    std::array<char, most_characters> buffer;
    while (gzgets(gz(file_), buffer.data(), most_characters) != nullptr) {
        ++line_number_;
        line_ = buffer.data();
        const bool is_whole = !line_.empty() && line_.back() == '\n';
        if (!is_whole && gzeof(gz(file_)) == 0) {
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
    const char* said = gzerror(gz(file_), &error);
    if (error != Z_OK && error != Z_STREAM_END) {
        refuse(std::string("cannot be read on (") + (error == Z_ERRNO ? std::strerror(errno) : said) + ")");
    }
    return false;
}

Disc TrajectoryFile::disc_of_line(std::vector<bool>& seen, std::size_t& index) {
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
        refuse("i: found disc " + std::to_string(*number) + " twice in step " + std::to_string(steps_read_) +
               ", expected each once");
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

void TrajectoryFile::refuse(const std::string& what) const {
    throw InputError(path_ + ":" + std::to_string(line_number_) + ": " + what);
}

} // namespace carom
