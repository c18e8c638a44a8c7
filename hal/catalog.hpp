// The catalog: everything that a run may name, by category and name, and where each entry came from.
//
//   void register_lift(hal::Registrar& registrar) {        one such function a folder, or a plug-in
//     registrar.add(hal::port_type<LiftDrive>());          ports, kinds of robot, devices, engines, bridges, …
//     registrar.add(lift_device);                          anything with a `kCategory` and a name
//   }
//   catalog.add_from("library 'lift.so'", register_lift);  checks all of them, and takes all or none
//   catalog.find<core::DeviceType>("actuator lift ideal")
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "hal/result.hpp"
#include "hal/surface.hpp"

namespace tandem::hal {

/// An entry as it crosses the border between libraries: its type is known by the category's name and its surface, never
/// by the language's own type information, which two libraries need not share.
struct CatalogItem {
  std::string_view category;  ///< "engine"
  std::string_view name;      ///< as files and people write it
  std::uint64_t layout = 0;   ///< of the entry's type: `entry_layout<T>()`
  const void* entry = nullptr;
  std::uint32_t size = 0;      ///< of the entry, in bytes: less than here where its type was appended to since
  std::string_view flaw = {};  ///< what makes it unusable, as in "has no body; …"; empty: nothing
};

/// Differs when a type of entries, or what crosses with them, was compiled to another form (hal/surface.hpp).
template <class T>
constexpr std::uint64_t entry_layout() noexcept {
  return detail::mixed(SurfaceOf<T>::kDigest, SurfaceOf<T>::kNumber);
}

/// The name of an entry in its category: what its `catalog_name()` says, or its `name`.
template <class T>
std::string catalog_name(const T& entry) {
  if constexpr (requires { entry.catalog_name(); }) {
    return std::string(entry.catalog_name());
  } else {
    return std::string(entry.name);
  }
}

struct ControllerType;
template <class T>
const ControllerType& controller_type(std::string_view name, std::string_view summary);  // hal/controller.hpp

/// Receives what a folder or a plug-in offers. Entries must live as long as the catalog: they are tables of functions
/// and constants.
class Registrar {
 public:
  virtual ~Registrar() = default;
  virtual void add(const CatalogItem& item) = 0;
  /// Entries of this surface may be added. Of plug-ins that is known before they are loaded.
  virtual void know(const Surface& surface) = 0;

  template <class T>
  requires(!std::is_same_v<T, CatalogItem>) void add(const T& entry) {
    detail::note_surface<T>();
    know(SurfaceOf<T>::value());
    const std::string name = hal::catalog_name(entry);
    std::string flaw;
    if constexpr (requires { entry.flaw(); }) flaw = entry.flaw();
    add(CatalogItem{T::kCategory, name, entry_layout<T>(), &entry, sizeof(T), flaw});
  }
  /// A class of controllers, as `controller_type` makes its table.
  template <class T>
  void add_controller(std::string_view name, std::string_view summary) {
    add(controller_type<T>(name, summary));
  }
};

/// Filled once, then constant. Copies share the entries.
class Catalog {
 public:
  /// Entries of this origin come with the program itself.
  static constexpr std::string_view kInside = "tandem";

  struct Entry {
    std::string category, name;
    std::uint64_t layout = 0;
    const void* entry = nullptr;
    std::string origin;
    std::shared_ptr<const void> widened = {};  ///< holds `entry`, where the one that was added is shorter
  };

  /// Adds all that `fill` registers, or nothing. Errors, all in one message: an entry without a name or without a type,
  /// or with a flaw (`std::string flaw() const` of its type); two of one category and name, with both origins; one
  /// whose type has another layout than here. Controllers and hooks are named together with their library: theirs need
  /// differ within one origin alone. What `fill` throws passes through.
  Status add_from(const std::string& origin, const std::function<void(Registrar&)>& fill);

  /// The entry of that name, or null.
  template <class T>
  const T* find(std::string_view name) const noexcept {
    return static_cast<const T*>(find(T::kCategory, entry_layout<T>(), name));
  }
  /// All entries of one type, in the order in which they were added.
  template <class T>
  std::vector<const T*> all() const {
    std::vector<const T*> found;
    for (const Entry& e : entries_) {
      if (e.category == T::kCategory && e.layout == entry_layout<T>()) found.push_back(static_cast<const T*>(e.entry));
    }
    return found;
  }
  std::vector<std::string> names(std::string_view category) const;
  /// There is an entry of that name in a part of the program that may not be loaded.
  void know_elsewhere(std::string_view category, std::string_view name);
  /// Names of those that are not here.
  std::vector<std::string> elsewhere(std::string_view category) const;
  /// Where that entry came from; empty when it is none.
  std::string origin_of(const void* entry) const;
  const std::vector<Entry>& entries() const noexcept { return entries_; }

  /// Plug-ins may add entries of this type, also where there is none yet.
  template <class T>
  void know() {
    know(SurfaceOf<T>::value());
  }
  void know(const Surface& surface);
  const std::vector<Surface>& surfaces() const noexcept { return surfaces_; }

 private:
  const void* find(std::string_view category, std::uint64_t layout, std::string_view name) const noexcept;

  std::vector<Entry> entries_;
  std::vector<Surface> surfaces_;                               // one a category
  std::vector<std::pair<std::string, std::string>> elsewhere_;  // category and name
};

}  // namespace tandem::hal
