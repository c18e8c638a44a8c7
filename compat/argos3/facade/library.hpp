// Libraries of users, built against the facade: their classes, by library.
#pragma once
#include <argos3/core/utility/plugins/factory.h>
#include <array>
#include <mutex>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hal/catalog.hpp"
#include "hal/surface.hpp"

namespace tandem::compat::argos3 {

/// The facade as a surface of plug-ins: a user's library names it in its note, so that the module is loaded before
/// it. Raise kNumber with any change of the classes in include/argos3 that users' libraries compile in.
struct Facade {
  static constexpr std::string_view kCategory = "argos3";
  static constexpr std::uint32_t kNumber = 1;
  using Crosses = hal::Layouts<argos::tandem_detail::SRegistration>;
  std::string_view name, summary;
};

/// Registrations of the library that holds `address`, in the order of its macros.
std::vector<const argos::tandem_detail::SRegistration*> registrations_of(const void* address);

/// Calls `closed` whenever the library of a class is closed. The same function is kept once.
using Closed = void (*)(const argos::tandem_detail::SRegistration& registration) noexcept;
void on_closed(Closed closed);

/// Tables of classes. Those of Tandem are functions without data, so each class has functions of its own, by its
/// number.
template <class Table>
class ClassTables {
 public:
  using Registration = argos::tandem_detail::SRegistration;
  static constexpr std::size_t kMost = 256;

  /// The table of a class: always the same one, as long as its library is open. `fill` makes a new one's contents of
  /// its number. @throws std::runtime_error when the process has too many
  template <class Fill>
  static Table& of(const Registration& registration, Fill&& fill) {
    const std::lock_guard lock(all().mutex);
    std::size_t free = kMost;
    for (std::size_t i = kMost; i-- > 0;) {
      if (all().classes[i] == &registration) return all().tables[i];
      if (all().classes[i] == nullptr) free = i;
    }
    if (free == kMost)
      throw std::runtime_error("there are more than " + std::to_string(kMost) + " classes of the kind '" +
                               registration.Kind + "' of ARGoS' in one process");
    on_closed(&forget);
    all().classes[free] = &registration;
    all().tables[free] = {};
    fill(all().tables[free], free);
    return all().tables[free];
  }
  static const Registration& registration(std::size_t number) { return *all().classes[number]; }

 private:
  struct All {
    std::mutex mutex;
    std::array<const Registration*, kMost> classes{};
    std::array<Table, kMost> tables{};
  };
  static All& all() {
    static All* const one = new All;  // outlives static objects of libraries
    return *one;
  }
  static void forget(const Registration& closed) noexcept {
    const std::lock_guard lock(all().mutex);
    for (const Registration*& one : all().classes) {
      if (one == &closed) one = nullptr;
    }
  }
};

/// `Function::call<kNumber>` for the numbers of all tables.
template <class Function, std::size_t kMost>
constexpr auto functions_by_number() {
  return []<std::size_t... kNumbers>(std::index_sequence<kNumbers...>) {
    return std::array{&Function::template call<kNumbers>...};
  }
  (std::make_index_sequence<kMost>());
}

/// Adds all that this library has registered to the catalog (compat/argos3/register.cpp).
void register_library(const void* address, hal::Registrar& registrar);

}  // namespace tandem::compat::argos3
