#include "compat/argos3/facade/library.hpp"

#include <dlfcn.h>
#include <mutex>

namespace tandem::compat::argos3 {
namespace {

using argos::tandem_detail::SRegistration;

std::mutex mutex;
SRegistration* first = nullptr;  // the last that was registered comes first

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

}  // namespace tandem::compat::argos3

namespace argos::tandem_detail {

void Register(SRegistration& registration) {
  const std::lock_guard lock(tandem::compat::argos3::mutex);
  registration.Next = tandem::compat::argos3::first;
  tandem::compat::argos3::first = &registration;
}

}  // namespace argos::tandem_detail
