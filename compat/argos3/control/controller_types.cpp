#include "compat/argos3/control/controller_types.hpp"

#include <algorithm>
#include <array>
#include <mutex>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "compat/argos3/control/adapter.hpp"
#include "compat/argos3/facade/library.hpp"

namespace tandem::compat::argos3 {
namespace {

using argos::tandem_detail::SRegistration;

/// A registered class. Tables of controllers are functions without an argument of their own, so that each class has
/// functions of its own here, by its number.
struct Slot {
  const SRegistration* registration = nullptr;
  hal::ControllerType type;
};
constexpr std::size_t kMostClasses = 256;
std::array<Slot, kMostClasses> slots;
std::mutex slots_mutex;

template <std::size_t kSlot>
std::shared_ptr<const void> read_params(hal::ParamVisitor& visitor) {
  auto params = std::make_shared<Adapter::Params>();
  params->describe(visitor);
  params->registration = slots[kSlot].registration;
  return params;
}

template <std::size_t... kSlots>
constexpr auto readers(std::index_sequence<kSlots...>) {
  return std::array{&read_params<kSlots>...};
}
constexpr auto kReaders = readers(std::make_index_sequence<kMostClasses>());

/// Its library is closed.
void forget_controller(const SRegistration& registration) noexcept {
  const std::lock_guard lock(slots_mutex);
  for (Slot& slot : slots) {
    if (slot.registration == &registration) slot.registration = nullptr;
  }
}

/// The table of a class: always the same one, as long as its library is there.
const hal::ControllerType& type_of(const SRegistration& registration) {
  const std::lock_guard lock(slots_mutex);
  std::size_t free = kMostClasses;
  for (std::size_t i = kMostClasses; i-- > 0;) {
    if (slots[i].registration == &registration) return slots[i].type;
    if (slots[i].registration == nullptr) free = i;
  }
  if (free == kMostClasses)
    throw std::runtime_error("there are more than " + std::to_string(kMostClasses) +
                             " classes of ARGoS' controllers in one process");
  on_closed(&forget_controller);
  Slot& slot = slots[free];
  slot.registration = &registration;
  slot.type = hal::controller_type<Adapter>(registration.Label, "a controller of ARGoS'");
  slot.type.read_params = kReaders[free];
  return slot.type;
}

}  // namespace

void register_controllers(const std::vector<const SRegistration*>& registrations, hal::Registrar& registrar) {
  for (const SRegistration* const one : registrations) {
    if (one->Kind == std::string_view("controller")) registrar.add(type_of(*one));
  }
}

bool is_controller_of_argos(const hal::ControllerType& type) noexcept {
  return std::find(kReaders.begin(), kReaders.end(), type.read_params) != kReaders.end();
}

}  // namespace tandem::compat::argos3
