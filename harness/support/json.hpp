#pragma once

#include <cmath>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

// How values that may be missing stand in JSON: null, never a stand-in.

namespace carom {

/// JSON as text; bytes that are no UTF-8, as a file's name may hold, become the replacement character.
inline std::string json_text(const nlohmann::ordered_json& json, int indent) {
    return json.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

/// The value, or null where there is none.
template <class Value> nlohmann::ordered_json or_null(const std::optional<Value>& value) {
    return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

/// A number, or null where there is none or it is not finite.
inline nlohmann::ordered_json number_or_null(const std::optional<double>& value) {
    return value && std::isfinite(*value) ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

/// The text, or the texts by name, or null if there is none.
template <class Text> nlohmann::ordered_json text_or_null(const Text& text) {
    return text.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(text);
}

} // namespace carom
