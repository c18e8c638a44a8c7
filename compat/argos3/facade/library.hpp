// Libraries of users, built against the facade: their classes, by library.
#pragma once
#include <argos3/core/utility/plugins/factory.h>
#include <string_view>
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

/// Adds all that this library has registered to the catalog (compat/argos3/register.cpp).
void register_library(const void* address, hal::Registrar& registrar);

}  // namespace tandem::compat::argos3
