#include "harness/scenes/disc_lines.hpp"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cmath>
#include <memory>
#include <system_error>
#include <vector>

#include "harness/scenes/scene_file.hpp"
#include "kernels/parallel_for.hpp"

namespace carom {
namespace {

/// A thread takes the lines that begin within so many bytes at a time: they stay in its cache.
constexpr std::size_t block_size = 1 << 15;
constexpr std::size_t longest_line = 1 << 12;
constexpr std::size_t buffer_size = 1 + block_size + longest_line;

bool is_blank(char letter) { return letter == ' ' || letter == '\t' || letter == '\r'; }

/// Reads fields off a piece of the text that ends with a line.
class Fields {
  public:
    explicit Fields(std::string_view text) : at_(text.data()), end_(text.data() + text.size()) {}

    const char* at() const { return at_; }

    /// False if the next field of the line is no such number.
    template <class Number> bool number(Number& value) {
        skip_blanks();
        const auto [stop, error] = std::from_chars(at_, end_, value);
        at_ = stop;
        return error == std::errc{} && (at_ == end_ || *at_ == '\n' || is_blank(*at_));
    }

    bool bounded(double& value) { return number(value) && std::abs(value) <= largest_number; }

    /// False if there is another field on the line.
    bool line_end() {
        skip_blanks();
        return at_ == end_ || *at_++ == '\n';
    }

  private:
    void skip_blanks() {
        while (at_ != end_ && is_blank(*at_)) {
            ++at_;
        }
    }

    const char* at_;
    const char* end_;
};

/// The text and the discs, to be read block by block.
class DiscLines {
  public:
    DiscLines(const Pieces& text, std::size_t begin, std::size_t end, std::span<Disc> discs)
        : text_(text), begin_(begin), end_(end), discs_(discs), taken_(discs.size()) {}

    std::size_t blocks() const { return (end_ - begin_ + block_size - 1) / block_size; }

    /// Reads the lines that begin in the block; false if one is not good. Blocks may be read side by side.
    bool read_block(std::size_t block, std::span<char> buffer) {
        const std::size_t first = begin_ + block * block_size;
        const std::size_t last = std::min(first + block_size, end_);
        const std::size_t from = block == 0 ? first : first - 1;
        const std::size_t until = std::min(last + longest_line, end_);
        std::string_view piece = text_.at(from, buffer.first(until - from));
        if (piece.size() < until - from) {
            return false;
        }
        const auto before = block == 0 ? 0 : piece.find('\n') + 1;
        if (block > 0 && before == 0) {
            return true; // a line of the block before, which it finds too long
        }
        if (until < end_) {
            piece = piece.substr(0, piece.rfind('\n') + 1);
        }
        Fields fields(piece.substr(before));
        const char* const stop = piece.data() + (last - from);
        while (fields.at() < stop) {
            if (!read_line(fields)) {
                return false;
            }
        }
        return true;
    }

    bool all_read() const {
        return std::ranges::all_of(taken_, [](const std::atomic<bool>& taken) { return taken.load(); });
    }

  private:
    bool read_line(Fields& fields) {
        long long number = 0;
        Disc disc;
        if (!(fields.number(number) && fields.bounded(disc.x) && fields.bounded(disc.y) &&
              fields.bounded(disc.vx) && fields.bounded(disc.vy) && fields.line_end())) {
            return false;
        }
        const auto i = static_cast<std::size_t>(number);
        if (number < 0 || i >= discs_.size() || taken_[i].exchange(true, std::memory_order_relaxed)) {
            return false;
        }
        discs_[i] = disc;
        return true;
    }

    const Pieces& text_;
    std::size_t begin_;
    std::size_t end_;
    std::span<Disc> discs_;
    std::vector<std::atomic<bool>> taken_; ///< a disc that stands twice is written by one thread alone
};

/// Where the text ends but for blank lines; not looked for further than a buffer holds.
std::size_t end_of_lines(const Pieces& text, std::size_t begin, std::span<char> buffer) {
    const std::size_t from = std::max(begin, text.size - std::min(text.size, buffer.size()));
    const std::string_view piece = text.at(from, buffer.first(text.size - from));
    const auto last = piece.find_last_not_of(" \t\r\n");
    const bool found = piece.size() == text.size - from && last != std::string_view::npos;
    return found ? from + last + 1 : text.size;
}

} // namespace

bool read_disc_lines(const Pieces& text, std::size_t begin, std::span<Disc> discs, int threads) {
    const std::size_t blocks = (text.size - std::min(begin, text.size) + block_size - 1) / block_size;
    const int needed =
        static_cast<int>(std::clamp<std::size_t>(blocks, 1, static_cast<std::size_t>(threads)));
    const auto buffers =
        std::make_unique_for_overwrite<char[]>(static_cast<std::size_t>(needed) * buffer_size);
    const auto buffer = [&buffers](int thread) {
        return std::span(&buffers[static_cast<std::size_t>(thread) * buffer_size], buffer_size);
    };
    DiscLines lines(text, begin, end_of_lines(text, begin, buffer(0)), discs);
    std::atomic<std::size_t> next = 0;
    std::atomic<bool> good = true;
    on_each_thread(needed, [&](int thread) {
        for (std::size_t block = next++; block < lines.blocks() && good; block = next++) {
            if (!lines.read_block(block, buffer(thread))) {
                good = false;
            }
        }
    });
    return good && lines.all_read();
}

} // namespace carom
