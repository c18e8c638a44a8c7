#include "compat/argos3/facade/library.hpp"

#include <algorithm>
#include <dlfcn.h>
#include <mutex>

namespace tandem::compat::argos3 {
namespace {

using argos::tandem_detail::SRegistration;

std::mutex mutex;
SRegistration* first = nullptr;  // the last that was registered comes first
std::vector<Closed>& closed() {
  static std::vector<Closed>* const all = new std::vector<Closed>;  // outlives static objects of libraries
  return *all;
}

/// Where the library that holds `address` begins.
const void* library_of(const void* address) noexcept {
  Dl_info info{};
  return dladdr(address, &info) != 0 ? info.dli_fbase : nullptr;
}

}  // namespace

std::vector<const SRegistration*> registrations_of(const void* address) {
  const std::lock_guard lock(mutex);
  const void* const library = library_of(address);
  std::vector<const SRegistration*> found;
  for (const SRegistration* one = first; one != nullptr; one = one->Next) {
    if (library_of(one) == library) found.insert(found.begin(), one);
  }
  return found;
}

void on_closed(Closed told) {
  const std::lock_guard lock(mutex);
  if (std::find(closed().begin(), closed().end(), told) == closed().end()) closed().push_back(told);
}

}  // namespace tandem::compat::argos3

namespace argos::tandem_detail {

namespace compat = tandem::compat::argos3;

void Register(SRegistration& registration) {
  const std::lock_guard lock(compat::mutex);
  registration.Next = compat::first;
  compat::first = &registration;
}

void Unregister(SRegistration& registration) {
  std::vector<compat::Closed> told;
  {
    const std::lock_guard lock(compat::mutex);
    for (SRegistration** at = &compat::first; *at != nullptr; at = &(*at)->Next) {
      if (*at == &registration) {
        *at = registration.Next;
        break;
      }
    }
    told = compat::closed();
  }
  for (const compat::Closed one : told) one(registration);
}

}  // namespace argos::tandem_detail
