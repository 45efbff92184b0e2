// Large arrays in large pages: the program's operator new asks the system for pages of 2 MB wherever a block has room
// for some.
//
// A model of 10^5 bodies fills hundreds of megabytes once, and sweeps through them: with pages of 4 kB one tenth to one
// fifth of the time goes into handing them out and finding them again. Where the system has no such pages, or keeps
// them to itself, nothing changes. For programs, not for the library, whose users choose their own.
#include <cstdlib>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace {

constexpr std::size_t large_page = std::size_t{1} << 21, large_block = 2 * large_page;

void* allocate(std::size_t size) noexcept {
#if defined(__linux__) && defined(MADV_HUGEPAGE)
  if (size >= large_block) {
    void* block = nullptr;
    if (posix_memalign(&block, large_page, size) != 0) return nullptr;
    // A wish: its refusal is no error.
    static_cast<void>(madvise(block, size, MADV_HUGEPAGE));
    return block;
  }
#endif
  return std::malloc(size > 0 ? size : 1);
}

}  // namespace

void* operator new(std::size_t size) {
  for (;;) {
    if (void* block = allocate(size)) return block;
    const std::new_handler handler = std::get_new_handler();
    if (!handler) throw std::bad_alloc();
    handler();
  }
}

void operator delete(void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }
