// SPDX-License-Identifier: BSD-3-Clause
#include <charconv>
#include <plica/core/error.hpp>
#include <plica/drivers/app/report/read_files.hpp>
#include <plica/meshes/files/file_bytes.hpp>
#include <plica/meshes/files/vtu_arrays.hpp>
#include <sstream>

namespace plica::app {
namespace {

class FrameReader {
 public:
  explicit FrameReader(const std::filesystem::path& path)
      : file_(load_file(path)), arrays_(file_) {}

  FrameFile read() {
    const std::vector<XmlElement> elements = vtu_elements(file_);
    for (const XmlElement& element : elements) prepare(element);
    for (const XmlElement& element : elements)
      if (element.name == "DataArray") take(element);
    take_cells();
    return std::move(frame_);
  }

 private:
  void prepare(const XmlElement& element) {
    if (element.name == "VTKFile") arrays_.header(element);
    if (element.name == "AppendedData") arrays_.appended(element);
    if (element.name != "Piece") return;
    points_ = attribute_count(element, "NumberOfPoints", file_);
    cells_ = attribute_count(element, "NumberOfCells", file_);
  }

  void take(const XmlElement& array) {
    if (array.parent == "Cells") {
      const std::string& name = attribute(array, "Name", file_);
      if (name == "connectivity") connectivity_ = array;
      if (name == "offsets") offsets_ = array;
    } else if (array.parent == "Points") {
      const std::vector<double> values = numbers(array, 3 * points_);
      for (std::size_t i = 0; i < values.size(); i += 3)
        frame_.points.emplace_back(values[i], values[i + 1], values[i + 2]);
    } else if (array.parent == "PointData" || array.parent == "CellData") {
      const bool of_cells = array.parent == "CellData";
      const std::int64_t components = attribute_count(array, "NumberOfComponents", file_);
      frame_.arrays.push_back({attribute(array, "Name", file_), of_cells,
                               static_cast<int>(components),
                               numbers(array, (of_cells ? cells_ : points_) * components)});
    }
  }

  std::vector<double> numbers(const XmlElement& array, std::int64_t count) {
    std::vector<double> values;
    arrays_.read(array, [&](Numbers& source, NumberType type) {
      values.reserve(
          static_cast<std::size_t>(source.checked_count(count, "the size of an array", type, 1)));
      for (std::int64_t i = 0; i < count; ++i)
        values.push_back(is_integer(type)
                             ? static_cast<double>(source.integer(type, "a number of an array"))
                             : source.number(type, "a number of an array"));
    });
    return values;
  }

  void take_cells() {
    if (cells_ == 0) return;
    if (!offsets_ || !connectivity_)
      refuse(file_.name, {}, "there is no 'connectivity' or no 'offsets' in <Cells>");
    const auto corners = static_cast<std::int64_t>(numbers(*offsets_, cells_).back());
    if (corners != 3 * cells_ && corners != 4 * cells_)
      refuse(file_.name, offsets_->place, "the cells must be all triangles or all tetrahedra");
    std::vector<int> points;
    for (const double number : numbers(*connectivity_, corners)) {
      if (number < 0 || number >= static_cast<double>(points_))
        refuse(file_.name, connectivity_->place, "a cell has a point that is not there");
      points.push_back(static_cast<int>(number));
    }
    if (corners == 3 * cells_)
      for (std::size_t i = 0; i < points.size(); i += 3)
        frame_.triangles.push_back({points[i], points[i + 1], points[i + 2]});
    else
      for (std::size_t i = 0; i < points.size(); i += 4)
        frame_.tets.push_back({points[i], points[i + 1], points[i + 2], points[i + 3]});
  }

  FileBytes file_;
  VtuArrays arrays_;
  FrameFile frame_;
  std::optional<XmlElement> connectivity_, offsets_;
  std::int64_t points_ = 0, cells_ = 0;
};

}  // namespace

const FrameArray* FrameFile::find(const std::string& name) const {
  for (const FrameArray& array : arrays)
    if (array.name == name) return &array;
  return nullptr;
}

FrameFile read_frame(const std::filesystem::path& vtu) { return FrameReader(vtu).read(); }

std::vector<FilmEntry> read_collection(const std::filesystem::path& pvd) {
  const FileBytes file = load_file(pvd);
  std::vector<FilmEntry> entries;
  for (const XmlElement& element : vtu_elements(file)) {
    if (element.name != "DataSet") continue;
    const std::string& text = attribute(element, "timestep", file);
    double time = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), time);
    if (error != std::errc() || end != text.data() + text.size())
      refuse(file.name, element.place, "timestep is " + shown(text) + "; it must be a number");
    entries.push_back({time, pvd.parent_path() / attribute(element, "file", file)});
  }
  return entries;
}

using Json = nlohmann::ordered_json;

namespace {

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
  return fields;
}

double number_of(const std::string& text, const FileBytes& file, std::int64_t line) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    refuse(file.name, {line}, "expected a number, found " + shown(text));
  return value;
}

}  // namespace

Json read_columns(const std::filesystem::path& csv, std::size_t rows) {
  const FileBytes file = load_file(csv);
  std::istringstream stream(file.bytes);
  std::string line;
  std::getline(stream, line);
  const std::vector<std::string> names = fields_of(line);
  if (names.empty() || names.front() != "time")
    refuse(file.name, {1}, "expected columns that start with 'time'");
  std::vector<std::vector<double>> table;
  while (std::getline(stream, line)) {
    const std::vector<std::string> fields = fields_of(line);
    const auto number = static_cast<std::int64_t>(table.size()) + 2;
    if (fields.size() != names.size())
      refuse(file.name, {number},
             "expected " + std::to_string(names.size()) + " values, found " +
                 std::to_string(fields.size()));
    std::vector<double>& row = table.emplace_back();
    for (const std::string& field : fields) row.push_back(number_of(field, file, number));
  }
  Json columns = Json::object();
  for (const std::string& name : names) columns[name] = Json::array();
  const std::size_t kept = std::min(rows, table.size());
  for (std::size_t i = 0; i < kept; ++i) {
    const std::vector<double>& row = table[kept == 1 ? 0 : i * (table.size() - 1) / (kept - 1)];
    for (std::size_t k = 0; k < names.size(); ++k) columns[names[k]].push_back(row[k]);
  }
  return columns;
}

Json read_json(const std::filesystem::path& file, const std::vector<std::string>& keys) try {
  Json json = Json::parse(load_file(file).bytes);
  for (const std::string& key : keys)
    if (!json.is_object() || !json.contains(key))
      throw InputError("it is not what plica wrote there: there is no '" + key + "'",
                       {file.string()});
  return json;
} catch (const Json::exception& error) {
  throw InputError(std::string("it is damaged: ") + error.what(), {file.string()});
}

}  // namespace plica::app
