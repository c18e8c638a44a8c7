// Ports as bytes of the lock-step protocol: the same on every machine, whatever its alignment.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hal/json/json.hpp"
#include "hal/port.hpp"

namespace tandem::bridges::peer {

/// Bytes of one class of ports: first the fields of which all elements are in use, then the others, each as far as it
/// is in use; scalars little-endian and without gaps. Looks up no names once it is made.
class RowForm {
 public:
  explicit RowForm(const hal::RowType& type);

  void pack(const void* row, std::vector<std::uint8_t>& out) const;
  /// Takes a row from the front of `in`. False: too short, or more in use than there can be; `row` is then in part
  /// written.
  bool unpack(std::span<const std::uint8_t>& in, void* row) const noexcept;

  /// Differs when names, types or counts do: 16 hexadecimal digits of FNV-1a over "name\n" and, for each field as it is
  /// on the wire, "name:type:count:used_by\n".
  const std::string& digest() const noexcept { return digest_; }
  /// [["distance", "f32", 24, "count", 1], …]: name, type, count, which field tells how many entries are in use ("":
  /// all are), and how many elements an entry has.
  hal::Json fields() const;

 private:
  struct Part {
    const hal::Field* field;
    std::size_t bytes;       // of a scalar
    const hal::Field* used;  // null: all
    std::size_t per_entry = 1;
  };
  static bool in_use(const Part& part, const void* row, std::size_t& count) noexcept;

  std::vector<Part> parts_;
  std::string digest_;
};

}  // namespace tandem::bridges::peer
