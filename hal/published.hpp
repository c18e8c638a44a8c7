// State that a controller shows to records and views.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "hal/port.hpp"

namespace tandem::hal {

/// One member of a controller, described: where it lies in the controller, and what it means. A description holds for
/// all controllers of its class, and for their copies.
struct PublishedField {
  std::string name;
  std::size_t offset = 0;  ///< from the controller's address
  Scalar scalar = Scalar::F64;
  std::size_t count = 1;
  Unit unit = unit::none;
  std::string doc;
  std::vector<std::string> texts;  ///< of an enumeration: its values from 0 on, in words; empty: a number

  bool operator==(const PublishedField& other) const noexcept;
};

/// The value as a number (bool: 0 or 1; an enumeration: its number). `controller` is the address of one of its class.
double value_of(const PublishedField& field, const void* controller, std::size_t index = 0) noexcept;

/// The value for people: "search", "0.25 m", "[1 2 3]".
std::string text_of(const PublishedField& field, const void* controller);

/// Size in the controller, in bytes.
std::size_t size_of(const PublishedField& field) noexcept;

}  // namespace tandem::hal
