#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace carom {

/// How much memory the system could still give to programs, in bytes, without paging: MemAvailable of
/// /proc/meminfo. Empty if it does not tell.
std::optional<std::int64_t> available_memory(const std::filesystem::path& root = "/");

/// How much address space the limit of this process leaves it, in bytes. Empty if there is no limit.
std::optional<std::int64_t> free_address_space(const std::filesystem::path& root = "/");

/// How much memory this process may still take, in bytes: what is available, what its control groups leave
/// (version 2: memory.max less memory.current, but for files, which make room) and its address space. Empty
/// if nobody tells.
std::optional<std::int64_t> free_memory(const std::filesystem::path& root = "/");

/// Throws InputError if there is less than `bytes`, which `needed_for` takes at least: in one line, before
/// anything is allocated. Asks only where they are many.
void require_memory(std::int64_t bytes, const std::string& needed_for);

} // namespace carom
