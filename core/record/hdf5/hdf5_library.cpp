// Users of the HDF5 library, in a shared object that is loaded when such a file is written. The tables are plain data
// sets (ticks by robots, NaN for no value, padded lists), readable by `h5py.File(f)["pose/x"]`. Records themselves have
// a format of their own: a killed writer leaves HDF5 files unreadable, and its journal (SWMR) forbids members that come
// later.
#include <algorithm>
#include <array>
#include <hdf5.h>
#include <map>
#include <string_view>

#include "core/record/hdf5/hdf5_file.hpp"

namespace tandem::core {
namespace {

/// An id of the library, given back when it goes.
class Id {
 public:
  Id() = default;
  Id(hid_t id, herr_t (*closes)(hid_t)) : id_(id), close_(closes) {}
  Id(Id&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  Id& operator=(Id&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  Id(const Id&) = delete;
  Id& operator=(const Id&) = delete;
  ~Id() { (void)close(); }
  bool close() {
    const bool good = id_ < 0 || close_(id_) >= 0;
    id_ = H5I_INVALID_HID;
    return good;
  }
  bool good() const { return id_ >= 0; }
  hid_t get() const { return id_; }

 private:
  hid_t id_ = H5I_INVALID_HID;
  herr_t (*close_)(hid_t) = nullptr;
};

/// What the library says of its last failure: the system's words where it has them.
std::string last_error() {
  std::string said;
  const auto take = [](unsigned n, const H5E_error2_t* error, void* out) -> herr_t {
    auto& text = *static_cast<std::string*>(out);
    const std::string_view words = error->desc != nullptr ? error->desc : "";
    constexpr std::string_view kBegin = "error message = '";
    if (const std::size_t begin = words.find(kBegin); begin != std::string_view::npos) {
      const std::string_view rest = words.substr(begin + kBegin.size());
      text = rest.substr(0, rest.find('\''));
      return 1;
    }
    if (n == 0) text = words;
    return 0;
  };
  (void)H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take, &said);
  return said.empty() ? "the HDF5 library gives no reason" : said;
}

class File final : public Hdf5File {
 public:
  explicit File(std::string path) : path_(std::move(path)) {}

  bool open() {
    const Id access(H5Pcreate(H5P_FILE_ACCESS), &H5Pclose);
    (void)H5Pset_file_locking(access.get(), false, true);  // whoever opened the path has locked it
    // Every compound of a file is closed with it, so that a full disk is told here and not later.
    (void)H5Pset_fclose_degree(access.get(), H5F_CLOSE_STRONG);
    file_ = Id(H5Fcreate(path_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.get()), &H5Fclose);
    links_ = Id(H5Pcreate(H5P_LINK_CREATE), &H5Pclose);
    (void)H5Pset_create_intermediate_group(links_.get(), 1);
    return file_.good();
  }

  hal::Status add(const std::string& path, TableType type, const std::vector<std::size_t>& row) override {
    std::vector<hsize_t> now{0}, most{H5S_UNLIMITED}, chunk{1};
    std::size_t values = 1;
    for (const std::size_t size : row) {
      now.push_back(size);
      most.push_back(size);
      chunk.push_back(size);
      values *= size;
    }
    constexpr std::size_t kChunkValues = std::size_t{1} << 16;
    chunk[0] = std::clamp<hsize_t>(kChunkValues / std::max<std::size_t>(1, values), 1, kChunkValues);
    for (std::size_t i = 1; i < chunk.size(); ++i) chunk[i] = std::max<hsize_t>(1, chunk[i]);
    const Id space(H5Screate_simple(static_cast<int>(now.size()), now.data(), most.data()), &H5Sclose);
    const Id form(H5Pcreate(H5P_DATASET_CREATE), &H5Pclose);
    (void)H5Pset_chunk(form.get(), static_cast<int>(chunk.size()), chunk.data());
    (void)H5Pset_shuffle(form.get());
    (void)H5Pset_deflate(form.get(), 1);
    const hid_t stored = type == TableType::F32   ? H5T_IEEE_F32LE
                         : type == TableType::F64 ? H5T_IEEE_F64LE
                                                  : H5T_STD_I64LE;
    Id data(H5Dcreate2(file_.get(), path.c_str(), stored, space.get(), links_.get(), form.get(), H5P_DEFAULT),
            &H5Dclose);
    if (!data.good()) return failed(path);
    sets_[path] = {std::move(data), now};
    return {};
  }

  hal::Status append(const std::string& path, const double* values, std::size_t rows) override {
    Set& set = sets_.at(path);
    std::vector<hsize_t> start(set.size.size(), 0), count = set.size;
    start[0] = set.size[0];
    count[0] = rows;
    if (rows == 0 || std::find(count.begin(), count.end(), hsize_t{0}) != count.end()) return {};
    set.size[0] += rows;
    if (H5Dset_extent(set.data.get(), set.size.data()) < 0) return failed(path);
    const Id there(H5Dget_space(set.data.get()), &H5Sclose);
    const Id here(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr), &H5Sclose);
    if (H5Sselect_hyperslab(there.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr) < 0 ||
        H5Dwrite(set.data.get(), H5T_NATIVE_DOUBLE, here.get(), there.get(), H5P_DEFAULT, values) < 0)
      return failed(path);
    return {};
  }

  hal::Status add_texts(const std::string& path, const std::vector<std::string>& texts) override {
    const Id type = text_type();
    const hsize_t count = texts.size();
    const Id space(H5Screate_simple(1, &count, nullptr), &H5Sclose);
    const Id data(
        H5Dcreate2(file_.get(), path.c_str(), type.get(), space.get(), links_.get(), H5P_DEFAULT, H5P_DEFAULT),
        &H5Dclose);
    if (!data.good()) return failed(path);
    std::vector<const char*> pointers;
    for (const std::string& text : texts) pointers.push_back(text.c_str());
    if (count > 0 && H5Dwrite(data.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, pointers.data()) < 0)
      return failed(path);
    return {};
  }

  hal::Status describe(const std::string& path, const std::string& name, const std::string& text) override {
    const Id object(H5Oopen(file_.get(), path.c_str(), H5P_DEFAULT), &H5Oclose);
    const Id type = text_type();
    const Id space(H5Screate(H5S_SCALAR), &H5Sclose);
    const Id attribute(H5Acreate2(object.get(), name.c_str(), type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
                       &H5Aclose);
    const char* const pointer = text.c_str();
    if (!attribute.good() || H5Awrite(attribute.get(), type.get(), &pointer) < 0) return failed(path + " " + name);
    return {};
  }

  hal::Status close() override {
    bool good = true;
    for (auto& [path, set] : sets_) good = set.data.close() && good;
    sets_.clear();
    good = H5Fflush(file_.get(), H5F_SCOPE_GLOBAL) >= 0 && good;
    const hal::Status told = good ? hal::Status{} : failed("the end");
    (void)file_.close();
    return told;
  }

 private:
  struct Set {
    Id data;
    std::vector<hsize_t> size;
  };

  static Id text_type() {
    Id type(H5Tcopy(H5T_C_S1), &H5Tclose);
    (void)H5Tset_size(type.get(), H5T_VARIABLE);
    (void)H5Tset_cset(type.get(), H5T_CSET_UTF8);
    return type;
  }
  hal::Status failed(const std::string& what) const {
    return hal::Error{"cannot write the HDF5 file '" + path_ + "' at " + what + ": " + last_error()};
  }

  std::string path_;
  Id file_, links_;
  std::map<std::string, Set> sets_;
};

}  // namespace
}  // namespace tandem::core

extern "C" __attribute__((visibility("default"))) bool tandem_hdf5_create(const std::string& path,
                                                                          std::unique_ptr<tandem::core::Hdf5File>& out,
                                                                          std::string& error);

/// `out` is the file; or, when false is returned, `error` says what is wrong.
bool tandem_hdf5_create(const std::string& path, std::unique_ptr<tandem::core::Hdf5File>& out, std::string& error) {
  (void)H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // nothing is printed
  auto file = std::make_unique<tandem::core::File>(path);
  if (!file->open()) {
    error = "cannot write the HDF5 file '" + path + "': " + tandem::core::last_error();
    return false;
  }
  out = std::move(file);
  return true;
}
