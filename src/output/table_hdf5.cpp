#include <hdf5.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "windlass/output/atomic_file.hpp"
#include "windlass/output/checksum.hpp"
#include "windlass/output/error.hpp"
#include "windlass/output/table.hpp"

namespace windlass::output {

std::size_t Column::rows() const {
  const std::size_t count = std::visit([](const auto* v) { return v->size(); }, values);
  return count / static_cast<std::size_t>(width);
}

namespace {

/// Move-only owner of an HDF5 identifier.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t), const char* what) : id_(id), close_(close) {
    if (id_ < 0) throw OutputError(std::string("HDF5 cannot ") + what);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  hid_t get() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

void check(herr_t status, const char* what) {
  if (status < 0) throw OutputError(std::string("HDF5 cannot ") + what);
}

/// HDF5 prints a stack of errors on stderr; ours is one sentence, so its printing is off while this lives.
class QuietHdf5 {
 public:
  QuietHdf5() {
    H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~QuietHdf5() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }
  QuietHdf5(const QuietHdf5&) = delete;
  QuietHdf5& operator=(const QuietHdf5&) = delete;

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

Handle variable_string_type() {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "make a string type");
  check(H5Tset_size(type.get(), H5T_VARIABLE), "size a string type");
  check(H5Tset_cset(type.get(), H5T_CSET_UTF8), "set UTF-8");
  return type;
}

void write_attribute(hid_t object, const char* name, const std::string& text) {
  if (text.empty()) return;
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "make a string type");
  check(H5Tset_size(type.get(), text.size()), "size a string type");
  check(H5Tset_cset(type.get(), H5T_CSET_UTF8), "set UTF-8");
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, "make a scalar space");
  const Handle attribute(H5Acreate2(object, name, type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose, "make an attribute");
  check(H5Awrite(attribute.get(), type.get(), text.data()), "write an attribute");
}

void write_column(hid_t group, const Column& column) {
  const hsize_t sizes[2] = {column.rows(), static_cast<hsize_t>(column.width)};
  const Handle space(H5Screate_simple(column.width == 1 ? 1 : 2, sizes, nullptr), H5Sclose, "make a space");
  const bool text = column.values.index() == 2;
  const Handle string_type = variable_string_type();
  const hid_t memory = text                         ? string_type.get()
                       : column.values.index() == 1 ? H5T_NATIVE_INT64
                                                    : H5T_NATIVE_DOUBLE;
  const hid_t stored = text ? string_type.get() : column.values.index() == 1 ? H5T_STD_I64LE : H5T_IEEE_F64LE;
  const Handle set(
      H5Dcreate2(group, column.name.c_str(), stored, space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
      H5Dclose, "make a dataset");
  if (column.rows() > 0) {
    std::vector<const char*> pointers;
    const void* data = nullptr;
    if (text) {
      for (const std::string& value : *std::get<Column::Texts*>(column.values))
        pointers.push_back(value.c_str());
      data = pointers.data();
    } else {
      data = std::visit([](const auto* v) { return static_cast<const void*>(v->data()); }, column.values);
    }
    check(H5Dwrite(set.get(), memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), "write a dataset");
  }
  write_attribute(set.get(), "units", column.units);
  write_attribute(set.get(), "shape", column.width == 1 ? "N" : "N x " + std::to_string(column.width));
  write_attribute(set.get(), "meaning", column.meaning);
}

/// The finished file as bytes.
std::vector<char> file_image(const std::vector<Table>& tables, const std::string& about) {
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "make an access list");
  check(H5Pset_fapl_core(access.get(), 1 << 20, 0), "keep a file in memory");
  const Handle file(H5Fcreate("points.h5 (in memory)", H5F_ACC_TRUNC, H5P_DEFAULT, access.get()), H5Fclose,
                    "make a file in memory");
  write_attribute(file.get(), "about", about);
  for (const Table& table : tables) {
    const Handle group(H5Gcreate2(file.get(), table.name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                       H5Gclose, "make a group");
    write_attribute(group.get(), "meaning", table.meaning);
    for (const Column& column : table.columns) write_column(group.get(), column);
  }
  check(H5Fflush(file.get(), H5F_SCOPE_GLOBAL), "flush a file");
  const ssize_t size = H5Fget_file_image(file.get(), nullptr, 0);
  check(size < 0 ? -1 : 0, "measure a file image");
  std::vector<char> image(static_cast<std::size_t>(size));
  check(H5Fget_file_image(file.get(), image.data(), image.size()) < 0 ? -1 : 0, "copy a file image");
  return image;
}

void read_texts(hid_t set, std::size_t count, std::vector<std::string>& values) {
  const Handle type = variable_string_type();
  const Handle space(H5Dget_space(set), H5Sclose, "read a space");
  std::vector<char*> pointers(count, nullptr);
  check(H5Dread(set, type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, pointers.data()), "read a dataset");
  for (const char* pointer : pointers) values.emplace_back(pointer == nullptr ? "" : pointer);
  H5Dvlen_reclaim(type.get(), space.get(), H5P_DEFAULT, pointers.data());
}

void read_column(hid_t group, const Column& column) {
  const Handle set(H5Dopen2(group, column.name.c_str(), H5P_DEFAULT), H5Dclose, "open it");
  const Handle space(H5Dget_space(set.get()), H5Sclose, "read its shape");
  hsize_t sizes[2] = {0, 1};
  if (H5Sget_simple_extent_ndims(space.get()) > 2) throw OutputError("it has too many dimensions");
  H5Sget_simple_extent_dims(space.get(), sizes, nullptr);
  if (sizes[1] != static_cast<hsize_t>(column.width)) throw OutputError("its shape is wrong");
  const std::size_t count = sizes[0] * sizes[1];
  std::visit([](auto* v) { v->clear(); }, column.values);
  if (count == 0) return;
  if (const auto* texts = std::get_if<Column::Texts*>(&column.values)) {
    read_texts(set.get(), count, **texts);
  } else if (const auto* integers = std::get_if<Column::Integers*>(&column.values)) {
    (*integers)->resize(count);
    check(H5Dread(set.get(), H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, (*integers)->data()),
          "read it");
  } else {
    Column::Reals& reals = *std::get<Column::Reals*>(column.values);
    reals.resize(count);
    check(H5Dread(set.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, reals.data()), "read it");
  }
}

}  // namespace

void write_tables(const std::filesystem::path& path, const std::vector<Table>& tables,
                  const std::string& about) {
  const QuietHdf5 quiet;
  std::vector<char> image;
  try {
    image = file_image(tables, about);
  } catch (const OutputError& error) {
    throw OutputError("cannot write " + path.string() + ": " + error.what());
  }
  replace_file(path, std::string_view(sealed({image.data(), image.size()})));
}

void read_tables(const std::filesystem::path& path, const std::vector<Table>& tables) {
  const QuietHdf5 quiet;
  if (!std::filesystem::exists(path)) throw OutputError("cannot read " + path.string() + ": no such file");
  if (::access(path.c_str(), R_OK) != 0)
    throw OutputError("cannot read " + path.string() + ": " + std::generic_category().message(errno));
  unsealed(read_file(path), path.string());  // HDF5 opens nothing that is damaged
  const hid_t id = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (id < 0) throw OutputError("cannot read " + path.string() + ": it is truncated or not an HDF5 file");
  const Handle file(id, H5Fclose, "open a file");
  for (const Table& table : tables) {
    const hid_t group_id = H5Gopen2(file.get(), table.name.c_str(), H5P_DEFAULT);
    if (group_id < 0) throw OutputError("cannot read " + path.string() + ": it has no group " + table.name);
    const Handle group(group_id, H5Gclose, "open a group");
    for (const Column& column : table.columns) {
      try {
        read_column(group.get(), column);
      } catch (const OutputError& error) {
        throw OutputError("cannot read " + path.string() + ": dataset " + table.name + "/" + column.name +
                          ": " + error.what());
      }
    }
  }
}

}  // namespace windlass::output
