// Archive: writes values into bytes, or reads them from there; one function names all that something remembers.
//
//   void remember(hal::Archive& a) { a(items_, collected_, chance_); }
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

namespace tandem::hal {
namespace detail {

template <class T>
inline constexpr bool kIsVariant = false;
template <class... T>
inline constexpr bool kIsVariant<std::variant<T...>> = true;

}  // namespace detail

/// Numbers, enumerations and other values without addresses go byte by byte, as this processor has them; so do classes
/// that can be copied so. Texts, containers, optionals, pairs and variants of such; and classes with a member
/// `remember(Archive&)`. An address is none of them: a class that holds one names its other members.
class Archive {
 public:
  Archive() = default;  ///< writes
  /// Reads `bytes`, which must outlive this.
  explicit Archive(std::string_view bytes) noexcept : left_(bytes), reads_(true) {}

  bool reads() const noexcept { return reads_; }
  /// Whether there were bytes for all that was read so far; what came after those that were missing keeps its value.
  bool ok() const noexcept { return ok_; }
  /// Whether all was read, and nothing is left.
  bool at_end() const noexcept { return ok_ && left_.empty(); }
  const std::string& bytes() const noexcept { return bytes_; }  ///< that were written
  std::string take() noexcept { return std::move(bytes_); }

  template <class... T>
  void operator()(T&... values) {
    (value(values), ...);
  }

  /// Writes `now`, or reads what was written there. @returns whether they are the same.
  template <class T>
  bool same(const T& now) {
    T was = now;
    value(was);
    return ok_ && was == now;
  }

  void raw(void* at, std::size_t size) {
    if (!reads_) {
      bytes_.append(static_cast<const char*>(at), size);
    } else if ((ok_ = ok_ && size <= left_.size())) {
      if (size > 0) std::memcpy(at, left_.data(), size);
      left_.remove_prefix(size);
    }
  }

 private:
  template <class T>
  static constexpr bool kPlain = std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>;

  /// How many elements a container has, or is to have: never more than there are bytes for.
  std::size_t count(std::size_t now, std::size_t least_bytes) {
    std::uint64_t count = now;
    raw(&count, sizeof count);
    if (!reads_) return now;
    ok_ = ok_ && count <= left_.size() / least_bytes;
    return ok_ ? static_cast<std::size_t>(count) : 0;
  }

  template <class T>
  void value(T& v) {
    if constexpr (requires { v.remember(*this); }) {
      v.remember(*this);
    } else if constexpr (std::is_same_v<T, bool>) {  // a byte of a file may be neither
      std::uint8_t byte = v ? 1 : 0;
      raw(&byte, sizeof byte);
      ok_ = ok_ && byte <= 1;
      if (ok_) v = byte == 1;
    } else if constexpr (kPlain<T>) {
      raw(&v, sizeof v);
    } else if constexpr (requires { typename T::key_type; }) {
      keyed(v);
    } else if constexpr (requires { v.resize(v.size()); }) {
      listed(v);
    } else if constexpr (requires { v.has_value(), v.emplace(); }) {
      bool there = v.has_value();
      value(there);
      if (there && !v) v.emplace();
      if (!there) v.reset();
      if (there) value(*v);
    } else if constexpr (detail::kIsVariant<T>) {
      auto index = static_cast<std::uint8_t>(v.index());
      value(index);
      ok_ = ok_ && index < std::variant_size_v<T>;
      if (ok_) alternative(v, index, std::make_index_sequence<std::variant_size_v<T>>());
    } else if constexpr (requires { v.first, v.second; }) {
      value(v.first);
      value(v.second);
    } else {
      for (auto& element : v) value(element);
    }
  }

  template <class List>
  void listed(List& list) {
    using Value = typename List::value_type;
    constexpr bool kBytes = kPlain<Value> && requires {
      list.data();
    };
    const std::size_t size = count(list.size(), kBytes ? sizeof(Value) : 1);
    if (reads_) list.resize(size);
    if constexpr (kBytes) {
      raw(list.data(), size * sizeof(Value));
    } else {
      for (auto& element : list) value(element);
    }
  }

  template <class Keyed>
  void keyed(Keyed& all) {
    const std::size_t size = count(all.size(), 1);
    if (!reads_) {
      for (auto& element : all) element_of<Keyed>(element);
      return;
    }
    all.clear();
    for (std::size_t i = 0; i < size && ok_; ++i) {
      typename Keyed::key_type key{};
      value(key);
      if constexpr (requires { typename Keyed::mapped_type; }) {
        typename Keyed::mapped_type mapped{};
        value(mapped);
        all.emplace(std::move(key), std::move(mapped));
      } else {
        all.insert(std::move(key));
      }
    }
  }
  template <class Keyed, class Entry>
  void element_of(Entry& element) {
    if constexpr (requires { typename Keyed::mapped_type; }) {
      value(const_cast<typename Keyed::key_type&>(element.first));  // written, not changed
      value(element.second);
    } else {
      value(const_cast<typename Keyed::key_type&>(element));
    }
  }

  template <class Variant, std::size_t... kIndex>
  void alternative(Variant& v, std::size_t index, std::index_sequence<kIndex...>) {
    const auto one = [&]<std::size_t k>(std::integral_constant<std::size_t, k>) {
      if (k != index) return;
      if (v.index() != k) v.template emplace<k>();
      value(std::get<k>(v));
    };
    (one(std::integral_constant<std::size_t, kIndex>()), ...);
  }

  std::string bytes_;
  std::string_view left_;
  bool reads_ = false, ok_ = true;
};

}  // namespace tandem::hal
