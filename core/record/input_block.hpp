// Inputs of a run as blocks of a record: in every tick all rows that reached the space from outside, as differences to
// the tick before.
//
// The payload: u8, 1 where it stands for itself (every so many ticks, and when members change), 0 where it is the
// difference to the block before, which is that of the tick before. Then, for each table (all; those that changed),
// numbers of LEB128: stream, members, bytes of the rows as in a block of Rows, bytes of the code; and the code: pairs
// of numbers, so many bytes are as they were, so many are different, and these, exclusive-or what was there. What a
// table is longer than the last time is as if it had been zeros.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "hal/result.hpp"
#include "hal/time.hpp"

namespace tandem::core {

/// Rows of one stream, encoded as in a block of Rows behind its four numbers.
struct InputTable {
  std::uint32_t stream = 0, members = 0;
  std::string rows;
};

class InputEncoder {
 public:
  static constexpr int kKeyEvery = 128;  ///< ticks

  /// The next block stands for itself.
  void forget() noexcept { since_key_ = 0; }
  /// Appends the payload for these tables, which are all there are.
  void encode(const std::vector<InputTable>& tables, std::string& out);

 private:
  int since_key_ = 0;
  std::map<std::uint32_t, std::string> last_;  // by stream
  std::string code_;
};

/// Goes through the blocks in their order.
class InputDecoder {
 public:
  struct Table {
    std::uint32_t stream = 0, members = 0;
    std::shared_ptr<const std::string> rows;
  };

  /// Takes the payload of the tick's block. Error: it makes no sense, or the block before it is missing; then none can
  /// be read until one that stands for itself.
  hal::Status decode(hal::Tick tick, std::string_view payload);
  /// What comes next is not that which follows: nothing is to be made of it until a block stands for itself.
  void lose() noexcept { known_ = false; }
  /// Whether the tables are those of the last block.
  bool known() const noexcept { return known_; }
  /// As of the last block, by stream.
  const std::map<std::uint32_t, Table>& tables() const noexcept { return tables_; }

 private:
  bool known_ = false;
  hal::Tick tick_ = 0;
  std::map<std::uint32_t, Table> tables_;
};

}  // namespace tandem::core
