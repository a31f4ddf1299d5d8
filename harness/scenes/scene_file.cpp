#include "harness/scenes/scene_file.hpp"

#include <cmath>
#include <vector>

#include "harness/support/errors.hpp"
#include "harness/support/free_memory.hpp"
#include "harness/support/input_file.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

constexpr const char* of_older_format = "the number of discs N, an integer (this is the older format, whose "
                                        "first line is `print` or `perf`: `tail "
                                        "-n +2 FILE > NEW` converts it)";

/// Reads a text line by line and field by field, and knows where it is.
class LineReader {
  public:
    LineReader(std::string_view text, const std::string& name) : rest_(text), name_(name) {}

    [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
        throw InputError(name_ + ":" + std::to_string(line_number_) + ": found " + found + ", expected " +
                         expected);
    }

    void next_line(std::string_view expected) {
        ++line_number_;
        if (rest_.empty()) {
            fail("the end of the file", std::string(expected));
        }
        const auto end = rest_.find('\n');
        line_ = rest_.substr(0, end);
        rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    }

    template <class Number> Number field(const char* expected) {
        const std::string_view text = take_word(line_);
        const auto value = parse_number<Number>(text);
        if (!value) {
            const bool is_older = line_number_ == 1 && (text == "print" || text == "perf");
            fail(text.empty() ? "the end of the line" : in_quotes(text),
                 is_older ? of_older_format : expected);
        }
        return *value;
    }

    double bounded(const char* expected) {
        const double value = field<double>(expected);
        if (!(std::abs(value) <= largest_number)) {
            fail(number_text(value), std::string(expected) + " of magnitude at most 1e60");
        }
        return value;
    }

    void end_line() {
        if (const std::string_view text = take_word(line_); !text.empty()) {
            fail(in_quotes(text), "the end of the line");
        }
    }

    void end_text() {
        while (!rest_.empty()) {
            next_line("");
            if (const std::string_view text = take_word(line_); !text.empty()) {
                fail(in_quotes(text), "the end of the file after the last disc");
            }
        }
    }

    std::size_t bytes_left() const { return rest_.size(); }

  private:
    std::string_view rest_;
    std::string_view line_;
    std::string name_;
    std::size_t line_number_ = 0;
};

template <class Number> Number sole_field(LineReader& reader, const char* expected) {
    reader.next_line(expected);
    const auto value = reader.field<Number>(expected);
    reader.end_line();
    return value;
}

/// The number of discs; refused, before anything is allocated, if the rest of the text cannot hold so many
/// lines.
std::size_t read_count(LineReader& reader) {
    const auto count = sole_field<long long>(reader, "the number of discs N, an integer");
    if (count < 0 || count > most_discs) {
        reader.fail(std::to_string(count), "a number of discs from 0 to " + std::to_string(most_discs));
    }
    constexpr std::size_t shortest_line = std::string_view("0 0 0 0 0").size();
    if (static_cast<std::size_t>(count) * shortest_line > reader.bytes_left()) {
        reader.fail(counted(count, "disc") + " in a file too short for so many",
                    "a line `i x y vx vy` for each");
    }
    return static_cast<std::size_t>(count);
}

/// The scene as its first four lines tell it, with room for its discs.
Scene read_header(LineReader& reader, const std::string& name, const RequireRoom& require_room) {
    const std::size_t count = read_count(reader);
    Scene scene;
    scene.side = sole_field<double>(reader, "the side of the box L, a number");
    scene.radius = sole_field<double>(reader, "the radius r, a number");
    require_radius(scene.radius, name + ":3");
    require_side(scene.side, scene.radius, name + ":2");
    scene.steps = sole_field<int>(reader, "the number of steps S, an integer");
    if (scene.steps < 0) {
        reader.fail(std::to_string(scene.steps), "a number of steps of at least 0");
    }
    require_room(scene, count);
    scene.discs.resize(count);
    return scene;
}

/// Line by line, which tells the first that is wrong.
void read_discs(LineReader& reader, std::vector<Disc>& discs) {
    const std::size_t count = discs.size();
    std::vector<bool> seen(count);
    for (std::size_t line = 0; line < count; ++line) {
        reader.next_line("one line `i x y vx vy` for each of the N discs");
        const auto number = reader.field<long long>("the number of a disc, an integer");
        if (number < 0 || number >= static_cast<long long>(count)) {
            reader.fail("disc " + std::to_string(number), "a disc from 0 to " + std::to_string(count - 1));
        }
        const auto i = static_cast<std::size_t>(number);
        if (seen[i]) {
            reader.fail("disc " + std::to_string(i) + " for the second time", "each disc once");
        }
        seen[i] = true;
        discs[i].x = reader.bounded("a position x");
        discs[i].y = reader.bounded("a position y");
        discs[i].vx = reader.bounded("a velocity vx");
        discs[i].vy = reader.bounded("a velocity vy");
        reader.end_line();
    }
}

Scene parse(std::string_view text, const std::string& name, const RequireRoom& require_room) {
    LineReader reader(text, name);
    Scene scene = read_header(reader, name, require_room);
    read_discs(reader, scene.discs);
    reader.end_text();
    return scene;
}

} // namespace

void require_room_for_discs(const Scene& /*box*/, std::size_t discs) {
    require_memory(static_cast<std::int64_t>(discs * sizeof(Disc)), counted(discs, "disc"));
}

void require_radius(double radius, const std::string& where) {
    if (!(radius >= smallest_radius && radius <= largest_number)) {
        throw InputError(where + ": found " + number_text(radius) + ", expected a radius from 1e-60 to 1e60");
    }
}

void require_side(double side, double radius, const std::string& where) {
    if (!(side >= 2 * radius && side <= largest_number)) {
        throw InputError(where + ": found " + number_text(side) +
                         ", expected a side from 2r = " + number_text(2 * radius) + " to 1e60");
    }
}

Scene parse_scene(std::string_view text, const std::string& name) {
    return parse(text, name, require_room_for_discs);
}

Scene read_scene(const std::filesystem::path& path, const RequireRoom& require_room) {
    return parse(read_file(path), shown_name(path), require_room);
}

std::string scene_text(const Scene& scene) {
    std::string text = std::to_string(scene.discs.size()) + "\n" + number_text(scene.side) + "\n" +
                       number_text(scene.radius) + "\n" + std::to_string(scene.steps) + "\n";
    return text + disc_lines(scene.discs);
}

} // namespace carom
