#include "core/space/large_memory.hpp"

#include <algorithm>
#include <cstring>
#include <sys/mman.h>

namespace tandem::core {
namespace {

constexpr std::size_t kHugePage = std::size_t{2} << 20;
constexpr std::size_t kLarge = 2 * kHugePage;  // below, a started page would be too large a part
constexpr std::size_t kPieceAlign = 64;
constexpr std::size_t kFirstPiece = std::size_t{64} << 10;
constexpr std::size_t kLastPiece = 4 * kHugePage;

std::size_t alignment(std::size_t size, std::size_t align) noexcept {
  return size < kLarge ? align : std::max(align, kHugePage);
}

}  // namespace

void* allocate_large(std::size_t size, std::size_t align) {
  void* p = ::operator new (size, std::align_val_t{alignment(size, align)});
  // Advice: a kernel without huge pages refuses, and the memory is what it is.
  if (size >= kLarge) (void)madvise(p, size, MADV_HUGEPAGE);
  return p;
}

void free_large(void* p, std::size_t size, std::size_t align) noexcept {
  ::operator delete (p, std::align_val_t{alignment(size, align)});
}

void Slab::Free::operator()(std::byte* p) const noexcept {
  free_large(p, size, kPieceAlign);
}

std::size_t Slab::bytes() const noexcept {
  std::size_t all = 0;
  for (const auto& piece : pieces_) all += piece.get_deleter().size;
  return all;
}

std::byte* Slab::take(std::size_t size, std::size_t align) {
  void* at = next_;
  if (next_ == nullptr || std::align(align, size, at, left_) == nullptr) {
    // Pieces grow with what was taken, so that few robots take little.
    const std::size_t grown = pieces_.empty() ? kFirstPiece : 2 * pieces_.back().get_deleter().size;
    const std::size_t piece = std::max(std::min(grown, kLastPiece), size + align);
    pieces_.emplace_back(static_cast<std::byte*>(allocate_large(piece, kPieceAlign)), Free{piece});
    at = pieces_.back().get();
    left_ = piece;
    at = std::align(align, size, at, left_);
  }
  next_ = static_cast<std::byte*>(at) + size;
  left_ -= size;
  std::memset(at, 0, size);
  return static_cast<std::byte*>(at);
}

}  // namespace tandem::core
