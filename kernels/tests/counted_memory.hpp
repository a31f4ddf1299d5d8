#pragma once

// For a test program of its own: replaces operator new of the whole process, and counts what it is asked for.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

#include <malloc.h>

namespace carom::tests::memory {

inline std::atomic<std::size_t> allocations = 0;
inline std::atomic<std::size_t> largest = 0; ///< that was asked for at once
inline std::atomic<std::size_t> held = 0;
inline std::atomic<std::size_t> most_held = 0;

inline void keep_most(std::atomic<std::size_t>& most, std::size_t now) {
    for (std::size_t before = most; now > before && !most.compare_exchange_weak(before, now);) {
    }
}

inline void* count_and_allocate(std::size_t size, std::size_t alignment) {
    ++allocations;
    keep_most(largest, size);
    void* memory = nullptr;
    if (posix_memalign(&memory, std::max(alignment, sizeof(void*)), size) != 0) {
        throw std::bad_alloc();
    }
    keep_most(most_held, held += malloc_usable_size(memory));
    return memory;
}

inline void release(void* memory) {
    held -= malloc_usable_size(memory);
    std::free(memory);
}

} // namespace carom::tests::memory

void* operator new(std::size_t size) {
    return carom::tests::memory::count_and_allocate(size, alignof(std::max_align_t));
}
void* operator new(std::size_t size, std::align_val_t alignment) {
    return carom::tests::memory::count_and_allocate(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept { carom::tests::memory::release(memory); }
void operator delete(void* memory, std::size_t) noexcept { carom::tests::memory::release(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { carom::tests::memory::release(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
    carom::tests::memory::release(memory);
}
