// What a program prints of its own time (stated_time.hpp).

#include <algorithm>
#include <cmath>
#include <regex>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/measure/stated_time.hpp"
#include "harness/processes/output_tail.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

constexpr double minute = 60;
constexpr double hour = 3600;
constexpr auto at_its_beginning = std::regex_constants::match_continuous;

/// Whole hours and minutes in front of what is left.
const std::string hours_and_minutes = "(?:([0-9]+)[ \t]*(?:h|hrs?|hours?)(?:[ \t,]|and)*)?"
                                      "(?:([0-9]+)[ \t]*(?:m|mins?|minutes?)(?:[ \t,]|and)*)?";

/// Between the digits of one number: also U+2019 and the blanks U+00A0 and U+202F, as locales have them.
const std::string between_digits = "(?:[.,'_]|\xE2\x80\x99|\xC2\xA0|\xE2\x80\xAF)";

std::regex regex_of(const std::string& pattern) {
    std::regex regex;
    try {
        regex.assign(pattern);
    } catch (const std::regex_error&) {
        throw InputError("time: found '" + pattern + "', expected a regular expression");
    }
    if (regex.mark_count() != 1) {
        throw InputError("time: found '" + pattern + "', expected a regular expression with one group");
    }
    return regex;
}

/// What a word stands for if it is a unit. A micro sign may be U+00B5 or U+03BC, or a byte of Latin-1, which
/// has become U+FFFD where it came through JSON.
std::optional<double> seconds_in(const std::string& word) {
    const std::string second = "s(?:ec(?:ond)?s?)?";
    const std::vector<std::pair<std::string, double>> units{
        {second, 1},
        {"m(?:illi)?" + second, 1e-3},
        {"(?:u|micro|\xC2\xB5|\xCE\xBC|\xB5|\xEF\xBF\xBD)" + second, 1e-6},
        {"n(?:ano)?" + second, 1e-9},
        {"m(?:in(?:ute)?s?)?", minute},
        {"h(?:(?:ou)?rs?)?", hour}};
    // A capital makes another unit of a short one.
    const auto letters =
        word.size() > 2 ? std::regex::ECMAScript | std::regex::icase : std::regex::ECMAScript;
    for (const auto& [name, seconds] : units) {
        if (std::regex_match(word, std::regex(name, letters))) {
            return seconds;
        }
    }
    return std::nullopt;
}

bool is_ambiguous(const std::string& number) {
    static const std::regex either("[1-9][0-9]{0,2},[0-9]{3}(?:[eE].*)?");
    return std::regex_match(number, either);
}

/// Of a number with a point or a comma before its decimals, with the other one or none between groups of
/// three digits, or with several such groups and no decimals.
std::optional<double> value_of(std::string number) {
    static const std::regex by_commas("[1-9][0-9]{0,2}(?:,[0-9]{3})+(?:\\.[0-9]+)?");
    static const std::regex by_points("[1-9][0-9]{0,2}(?:(?:\\.[0-9]{3})+,[0-9]+|(?:\\.[0-9]{3}){2,})");
    if (std::regex_match(number, by_commas)) {
        std::erase(number, ',');
    } else if (std::regex_match(number, by_points)) {
        std::erase(number, '.');
    }
    std::ranges::replace(number, ',', '.');
    return parse_number<double>(number);
}

/// What stands at the beginning of a text.
struct Reading {
    std::string number; ///< without its unit; empty if there is none
    std::optional<double> value;
    std::optional<double> unit; ///< in seconds
    std::string rest;           ///< of the text
};

Reading read_number(const std::string& text) {
    static const std::regex number("(?:[0-9]+(?:[.,][0-9]+)*|\\.[0-9]+)(?:[eE][-+]?[0-9]+)?");
    static const std::regex unit(
        "[ \t]*((?:\xC2\xB5|\xCE\xBC|\xB5|\xEF\xBF\xBD)?[A-Za-z]+)(?![A-Za-z_0-9]|\xC3)");
    std::smatch match;
    if (!std::regex_search(text, match, number, at_its_beginning)) {
        return {};
    }
    Reading read{.number = match.str(), .value = value_of(match.str()), .unit = {}, .rest = match.suffix()};
    const std::string behind = read.rest;
    if (std::regex_search(behind, match, unit, at_its_beginning) && (read.unit = seconds_in(match[1]))) {
        read.rest = match.suffix();
    }
    return read;
}

/// What `hours_and_minutes` has matched.
double seconds_of_larger_units(const std::smatch& match) {
    return hour * parse_number<double>(match[1].str()).value_or(0) +
           minute * parse_number<double>(match[2].str()).value_or(0);
}

/// Of hours, minutes and seconds in a row, their sum.
Reading read_time(const std::string& text) {
    static const std::regex larger(hours_and_minutes + "(?=[0-9])");
    std::smatch match;
    if (std::regex_search(text, match, larger, at_its_beginning) && match.length() > 0) {
        Reading last = read_number(match.suffix());
        if (last.value && last.unit >= 1 && last.unit < (match[2].matched ? minute : hour)) {
            // What may be thousands are decimals here, as bash's time prints them where a locale has commas.
            const double value = *last.value / (is_ambiguous(last.number) ? 1000 : 1);
            return {match.str() + last.number, seconds_of_larger_units(match) + value * *last.unit, 1,
                    last.rest};
        }
    }
    Reading one = read_number(text);
    if (text.ends_with("m" + one.rest)) { // metres, for all we know
        one.rest = text.substr(one.number.size());
        one.unit.reset();
    }
    return one;
}

/// Whether the pattern itself says this letter directly before its group, or behind it: then it knows that it
/// takes a part of what stands there.
bool says(const std::string& pattern, char letter, bool is_before) {
    const std::string mark = letter == '.' ? "\\." : std::string(1, letter);
    const auto holds = [&pattern](const std::string& text) {
        return pattern.find(text) != std::string::npos;
    };
    return std::string_view(".,'_-").find(letter) != std::string_view::npos &&
           (is_before ? holds(mark + "(") : holds(")" + mark) || holds(")\\" + mark));
}

/// Whether hours or minutes that are not zero stand before a number.
bool has_larger_units(const std::string& before, const std::string& number) {
    static const std::regex larger(hours_and_minutes + "$");
    static const std::regex clock("[1-9][0-9]*:(?:[0-9]+:)?[0-9]{2}(?:[.,][0-9]+)?$");
    std::smatch match;
    std::regex_search(before, match, larger);
    return seconds_of_larger_units(match) > 0 || std::regex_search(before + number, clock);
}

/// What the group of a match holds, with the line around it.
struct Group {
    std::string before;
    std::string text; ///< without blanks at its ends
    std::string behind;
    bool ends_match = false; ///< the pattern does not say what follows
};

Group group_of(const std::string& line, const std::smatch& match) {
    const auto begin = static_cast<std::size_t>(match.position(1));
    const std::string text = match[1];
    const std::size_t first = std::min(text.find_first_not_of(" \t"), text.size());
    const std::size_t length = text.find_last_not_of(" \t") + 1 - (first < text.size() ? first : 0);
    return {line.substr(0, begin + first), text.substr(first, length), line.substr(begin + first + length),
            match[1].second == match[0].second};
}

[[noreturn]] void refuse(const std::string& found, const std::string& expected) {
    throw InputError("time: found '" + on_one_line(found) + "'" + expected);
}

/// Whether blanks may separate the thousands of a number, of which the group takes a part: three digits
/// behind one to three, or one to three before three. Not where the pattern has a blank of its own there.
bool may_have_thousands(const Group& group, const std::string& number, const std::string& pattern) {
    static const std::regex thousands("(?:^|[^0-9.,])[1-9][0-9]{0,2} $");
    static const std::regex three_digits("[0-9]{3}(?:[.,][0-9]+)?");
    static const std::regex blank_before_group("(?: |\\\\s)[+*]?\\(");
    static const std::regex one_to_three("[1-9][0-9]{0,2}");
    static const std::regex three_more(" [0-9]{3}(?![0-9])");
    static const std::regex blank_behind_group("\\)(?: |\\\\s)");
    return (std::regex_search(group.before, thousands) && std::regex_match(number, three_digits) &&
            !std::regex_search(pattern, blank_before_group)) ||
           (std::regex_match(number, one_to_three) &&
            std::regex_search(group.behind, three_more, at_its_beginning) &&
            !std::regex_search(pattern, blank_behind_group));
}

/// Whether what the group takes is only a part of a longer number, or of a longer time. `behind` is what may
/// go on, nothing if the pattern says what does.
bool is_cut(const Group& group, const Reading& read, const std::string& behind, const std::string& pattern) {
    static const std::regex has_begun("(?:[0-9](?:[eE][-+]?|" + between_digits +
                                      ")?|(?:^|[^A-Za-z.])(?:[-.]|\xE2\x88\x92))$");
    static const std::regex goes_on("(?:" + between_digits + "|:|-|[eE][-+]?)?[0-9]");
    const bool ends_there = read.number.size() == group.text.size();
    return read.number.size() > group.text.size() ||
           (ends_there && std::regex_search(behind, goes_on, at_its_beginning)) ||
           (std::regex_search(group.before, has_begun) && !says(pattern, group.before.back(), true)) ||
           may_have_thousands(group, read.number, pattern) ||
           (read.unit.value_or(1) >= 1 && has_larger_units(group.before, read.number));
}

double seconds_of(const Group& group, const std::string& pattern, std::optional<double> unit_seconds) {
    const bool says_behind = !group.behind.empty() && says(pattern, group.behind.front(), false);
    const std::string behind = says_behind ? "" : group.behind;
    const Reading read = read_time(group.text + behind);
    if (!read.number.empty() && is_cut(group, read, behind, pattern)) {
        const std::string line = group.before + group.text + group.behind;
        refuse(group.text,
               " within a longer number in " + in_quotes(line) + ", expected a pattern that takes all of it");
    }
    if (is_ambiguous(read.number)) {
        refuse(group.text, ", which is ambiguous (thousands, or decimals?), expected a decimal point");
    }
    // Beyond the number it may take the unit, or the point of a whole number.
    const bool is_point = group.text == read.number + "." && parse_number<long long>(read.number);
    const auto unit = read.unit ? read.unit : unit_seconds;
    const double seconds = read.value.value_or(0) * unit.value_or(1);
    if ((read.rest.size() > behind.size() && !is_point) || !(seconds > 0) || !std::isfinite(seconds)) {
        const bool has_word = seconds > 0 && std::isfinite(seconds) &&
                              read.rest.find_first_of("0123456789") == std::string::npos;
        refuse(group.text, has_word
                               ? ", expected a number, and behind it at most a unit: ns, us, ms, s, min or h"
                               : ", expected a positive number");
    }
    static const std::regex other_unit("[ \t]*(%|[A-Za-z]*/s|(?:[kKMGT]i?)?B\\b|[kMG]?Hz|[kMG]s\\b)");
    static const std::regex letters("([A-Za-z]{1,3})(?![A-Za-z])"); // no word, as in 0:03.5elapsed
    std::smatch other;
    if (!read.unit && (std::regex_search(behind, other, other_unit, at_its_beginning) ||
                       (group.ends_match && std::regex_search(behind, other, letters, at_its_beginning)))) {
        refuse(group.text, " with the unit '" + other[1].str() + "', expected a time");
    }
    if (!unit) {
        refuse(group.text, " without a unit behind it, expected one such as ms, or --unit");
    }
    return seconds;
}

} // namespace

void require_pattern(const std::string& pattern) { regex_of(pattern); }

StatedTime time_in_output(const std::string& output, const std::string& pattern,
                          std::optional<double> unit_seconds) {
    const std::regex regex = regex_of(pattern);
    std::vector<std::string> found;
    Group group;
    std::istringstream lines(output);
    for (std::string line; std::getline(lines, line);) {
        if (line.size() > longest_line_matched) {
            continue;
        }
        const std::sregex_iterator first(line.begin(), line.end(), regex);
        for (auto match = first; match != std::sregex_iterator(); ++match) {
            // An empty one is what (.*) leaves behind a first.
            if (match->length() > 0 || match == first) {
                found.push_back(match->str());
                group = group_of(line, *match);
            }
        }
    }
    if (found.empty()) {
        throw InputError("time: '" + pattern + "' matches 0 lines of standard output, expected one");
    }
    if (found.size() > 1) {
        const char* const or_more = found.size() < most_lines_matched ? "" : " or more";
        throw InputError("time: '" + pattern + "' matches " + number_text(found.size()) + or_more +
                         " times in standard output, first " + in_quotes(found.front()) + " and last " +
                         in_quotes(found.back()) + ", expected once");
    }
    StatedTime time;
    time.seconds = seconds_of(group, pattern, unit_seconds);
    return time;
}

} // namespace carom
