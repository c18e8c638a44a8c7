// Records of runs in Python: their tables as arrays, their moments as pictures.
#include <algorithm>
#include <cmath>
#include <map>
#include <pybind11/stl.h>

#include "core/record/record_reader.hpp"
#include "core/record/record_source.hpp"
#include "core/record/record_tables.hpp"
#include "hal/json/json.hpp"
#include "python/picture.hpp"
#include "python/world.hpp"

namespace tandem::python {
namespace {

void expect(const hal::Status& done) {
  if (!done.ok()) throw py::value_error(done.error().message);
}
template <class Value>
Value taken(hal::Result<Value> result) {
  if (!result.ok()) throw py::value_error(result.error().message);
  return std::move(result).value();
}

/// Tables as numbers in memory; made without Python's lock.
class Arrays final : public core::TableSink {
 public:
  struct Set {
    core::TableType type = core::TableType::F64;
    std::vector<std::size_t> row;
    std::vector<float> floats;
    std::vector<double> doubles;
    std::vector<std::int64_t> wholes;
    std::vector<std::string> texts;
    bool is_text = false;
  };
  hal::Status add(const std::string& path, core::TableType type, const std::vector<std::size_t>& row) override {
    Set& set = sets_[path];
    set.type = type;
    set.row = row;
    return {};
  }
  hal::Status append(const std::string& path, const double* values, std::size_t rows) override {
    Set& set = sets_.at(path);
    for (const std::size_t n : set.row) rows *= n;
    const auto take = [&]<class T>(std::vector<T>& into) {
      for (std::size_t i = 0; i < rows; ++i) into.push_back(static_cast<T>(values[i]));
    };
    if (set.type == core::TableType::F32)
      take(set.floats);
    else if (set.type == core::TableType::F64)
      take(set.doubles);
    else
      take(set.wholes);
    return {};
  }
  hal::Status add_texts(const std::string& path, const std::vector<std::string>& texts) override {
    Set& set = sets_[path];
    set.texts = texts;
    set.is_text = true;
    return {};
  }
  hal::Status describe(const std::string&, const std::string&, const std::string&) override { return {}; }

  /// "pose/x": array, … With Python's lock.
  py::dict arrays() const {
    py::dict all;
    for (const auto& [path, set] : sets_) all[py::str(path.substr(1))] = array_of(set);
    return all;
  }

 private:
  template <class T>
  static py::object shaped(const std::vector<T>& values, const std::vector<std::size_t>& row) {
    std::size_t width = 1;
    for (const std::size_t n : row) width *= n;
    std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(width == 0 ? 0 : values.size() / width)};
    for (const std::size_t n : row) shape.push_back(static_cast<py::ssize_t>(n));
    return py::array_t<T>(shape, values.data());
  }
  static py::object array_of(const Set& set) {
    if (set.is_text) return py::cast(set.texts);
    if (set.type == core::TableType::F32) return shaped(set.floats, set.row);
    return set.type == core::TableType::F64 ? shaped(set.doubles, set.row) : shaped(set.wholes, set.row);
  }
  std::map<std::string, Set> sets_;
};

py::dict tables(const std::string& path, const std::string& table, std::vector<std::string> fields,
                std::vector<std::string> entities, std::optional<std::int64_t> from, std::optional<std::int64_t> until,
                std::int64_t every) {
  if (every < 1) throw py::value_error("every is 1 or more");
  Arrays arrays;
  hal::Status done;
  {
    const py::gil_scoped_release unlocked;
    auto opened =
        core::RecordTables::open({path, table, std::move(fields), std::move(entities), from, until, every, {}});
    done = opened.ok() ? opened.value().write(arrays) : hal::Status(opened.error());
  }
  expect(done);
  return arrays.arrays();
}

/// (what the record says of its run, titles of its tables, events as (tick, JSON), damage, whether it was cut)
py::tuple contents(const std::string& path) {
  auto reader = taken(core::RecordReader::open(path));
  std::vector<std::string> titles;
  while (const auto entry = reader.next()) {
    if (!entry->rows) continue;
    std::string title = entry->rows->stream().title();
    if (std::find(titles.begin(), titles.end(), title) == titles.end()) titles.push_back(std::move(title));
  }
  py::list events;
  for (const core::RecordEvent& event : reader.events())
    events.append(py::make_tuple(event.tick, hal::to_text(event.json)));
  return py::make_tuple(hal::to_text(reader.start()), titles, events, reader.damage(), reader.cut());
}

Picture picture(const std::string& path, std::optional<double> time_s, int size_px, bool ids, bool axes) {
  auto source = taken(core::RecordSource::open(path));
  if (time_s) {
    const double ticks = *time_s * static_cast<double>(source.ticks_per_second());
    if (!(std::abs(ticks) < 1e15)) throw py::value_error("the time of a picture is in s; this is none");
    source.go_to(static_cast<std::int64_t>(ticks + 0.5));
  } else {
    while (source.next()) {
    }
  }
  core::PictureOptions options;
  options.experiment = source.experiment();
  options.seed = source.seed();
  options.time_ns = hal::time_of_tick(source.ticks_done(), source.ticks_per_second());
  options.ticks_done = source.ticks_done();
  return picture_of(source.space(), std::move(options), size_px, ids, axes);
}

}  // namespace

void bind_records(py::module_& m) {
  m.def("_record_contents", &contents, py::arg("path"));
  m.def("_record_tables", &tables, py::arg("path"), py::arg("table"), py::arg("fields"), py::arg("entities"),
        py::arg("first"), py::arg("last"), py::arg("every"));
  m.def("_record_picture", &picture, py::arg("path"), py::arg("time"), py::arg("size"), py::arg("ids"),
        py::arg("axes"));
}

}  // namespace tandem::python
