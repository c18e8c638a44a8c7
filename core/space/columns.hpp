// Columns: state that is kept for robots, one row a robot of the groups that need it and nothing for the others.
#pragma once
#include <cstddef>
#include <cstring>
#include <memory>
#include <string_view>
#include <vector>

#include "hal/check.hpp"
#include "hal/port.hpp"
#include "hal/result.hpp"

namespace tandem::core {

/// The rows of one class of state, in arrays by block of robots. Row i of a block's array is that of its robot i.
struct ColumnArrays {
  const hal::RowType* type = nullptr;
  std::vector<std::byte*> of_block;  ///< null, or no element: the block's group needs none. Arrays never move

  std::byte* array(std::size_t block) const noexcept { return block < of_block.size() ? of_block[block] : nullptr; }
};

/// A column by its class, as its users keep it; valid as long as the space.
template <class T>
class Column {
 public:
  Column() = default;
  explicit Column(const ColumnArrays& arrays) : arrays_(&arrays) {}

  /// Whether no block has rows in it.
  bool empty() const noexcept { return arrays_ == nullptr || arrays_->of_block.empty(); }
  /// The rows of a block's robots, or null.
  T* of_block(std::size_t block) const noexcept {
    return arrays_ == nullptr ? nullptr : reinterpret_cast<T*>(arrays_->array(block));
  }
  /// The row of one robot, or null.
  T* at(std::size_t block, std::size_t slot) const noexcept {
    T* const rows = of_block(block);
    return rows == nullptr ? nullptr : rows + slot;
  }

 private:
  const ColumnArrays* arrays_ = nullptr;
};

/// All columns of a space. One that was made stays, whether any block has rows in it or not.
class Columns {
 public:
  /// The column of that name; made where there is none yet. Error: the name stands for rows of another layout.
  hal::Result<ColumnArrays*> of(const hal::RowType& type);
  template <class T>
  Column<T> of() {
    auto found = of(hal::row_type<T>());
    TANDEM_CHECK(found.ok(), "two classes of state in one program have the same name");
    return Column<T>(*found.value());
  }

  const std::vector<std::unique_ptr<ColumnArrays>>& all() const noexcept { return all_; }

 private:
  std::vector<std::unique_ptr<ColumnArrays>> all_;
};

/// A column that a group's robots need, and the row that each starts with.
struct KeptColumn {
  const hal::RowType* type = nullptr;
  std::vector<std::byte> first;
  ColumnArrays* arrays = nullptr;  ///< of the space that the group is in

  /// The row of a robot that comes.
  void start(std::size_t block, std::size_t slot) const noexcept {
    std::memcpy(arrays->array(block) + slot * type->size, first.data(), type->size);
  }
};

template <class T>
KeptColumn keeps(const T& first = {}) {
  KeptColumn kept{&hal::row_type<T>(), std::vector<std::byte>(sizeof(T)), nullptr};
  std::memcpy(kept.first.data(), &first, sizeof(T));
  return kept;
}

}  // namespace tandem::core
