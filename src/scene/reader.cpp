#include "windlass/scene/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "document.hpp"
#include "rules.hpp"
#include "values.hpp"
#include "walls.hpp"
#include "windlass/scene/keys.hpp"
#include "windlass/scene/resolved.hpp"

namespace windlass::scene {

namespace {

/// A document on its way to a Scene. The order of the steps matters: names, then the system of units, then the
/// values, then what must hold between them.
class Resolver {
 public:
  Resolver(const Document& document, const ReadOptions& options) : document_(document), options_(options) {}

  Scene resolve(const std::string& name) {
    refuse_single_wall(document_);
    check_plates_given(document_);
    check_names(document_);
    scene_.name = name;
    scene_.has_cylinder = document_.tables.contains("cylinder");
    if (document_.tables.contains("plate")) scene_.plate.emplace();
    if (document_.tables.contains("plate.2")) scene_.second_plate.emplace();
    read_continuation_parameter();
    find_units();
    for (const Entry& entry : document_.entries) fill(entry);
    derive();
    scene_.walls = read_walls(document_, scene_, physical_);
    check_rules(document_, scene_, options_.restart);
    scene_.resolved_toml = to_toml(scene_);
    return scene_;
  }

 private:
  void read_continuation_parameter() {
    if (!document_.tables.contains("continuation")) return;
    scene_.continuation.emplace();
    const Entry* entry = document_.find("continuation.parameter");
    if (!entry) return;
    const std::string name = read_text(*entry, *find_key(entry->key));
    // In a thin rod nothing depends on its radius.
    const Entry* touches = document_.find("rod.self_contact");
    const bool* said = touches ? std::get_if<bool>(&touches->value) : nullptr;
    const bool thick = said ? *said : document_.find("rod.radius") != nullptr;
    if (!is_numeric_key(name) || (name == "rod.radius" && !thick)) {
      std::string list;
      for (const Key& key : keys())
        if (key.is_parameter && (thick || key.name != "rod.radius"))
          list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ", key.name);
      throw SceneError(
          fmt::format("{}must be a key that a branch can be followed in, one of {}", entry->prefix(), list));
    }
    scene_.continuation->parameter = name;
  }

  /// The key whose dimension and range an entry has: for continuation.from and .to that of the parameter.
  const Key& meaning(const Key& key) const {
    return key.dimension == Dimension::of_parameter ? *find_key(scene_.continuation->parameter) : key;
  }

  /// In a physical scene every length, force and so on has a unit; only 0 and "inf" need none.
  /// Where some have one and some have not, the fewer are the mistake.
  void check_all_have_units() const {
    std::vector<const Entry*> bare, with_unit;
    for (const Entry& entry : document_.entries) {
      const Key& key = *find_key(entry.key);
      const Key& like = meaning(key);
      if (key.kind == ValueKind::text || !is_dimensional(like.dimension)) continue;
      const Number number = read_number(entry, key, like.dimension, like.range);
      if (number.has_unit) with_unit.push_back(&entry);
      if (number.has_unit || !std::isfinite(number.value) || number.value == 0.0) continue;
      if (key.name == "rod.youngs_modulus") throw SceneError(entry.prefix() + needs_unit(key, ""));
      bare.push_back(&entry);
    }
    if (bare.empty() || with_unit.empty()) return;
    if (with_unit.size() < bare.size())
      throw SceneError(with_unit.front()->prefix() +
                       "must be a number without a unit, like the other quantities of this scene");
    throw SceneError(bare.front()->prefix() + needs_unit(meaning(*find_key(bare.front()->key)),
                                                         ", like the other quantities of this scene"));
  }

  double in_si(const char* name) const {
    const Entry* entry = document_.find(name);
    if (!entry) throw missing(document_, name, "a physical scene needs it");
    const Key& key = *find_key(name);
    return read_number(*entry, key, key.dimension, key.range).value;
  }

  static std::string needs_unit(const Key& key, const char* why) {
    return fmt::format("must be {}{}", description(key.dimension), why);
  }

  /// Dimensionless, physical, or resolved: the scales are then given and both ways of writing have a meaning.
  void find_units() {
    const Entry* length = document_.find("scale.length");
    const Entry* stiffness = document_.find("scale.bending_stiffness");
    if (length || stiffness) {
      if (!length) throw missing(document_, "scale.length", "scale.bending_stiffness needs it");
      if (!stiffness) throw missing(document_, "scale.bending_stiffness", "scale.length needs it");
      const auto value = [](const Entry& entry) {
        const Key& key = *find_key(entry.key);
        return read_number(entry, key, key.dimension, key.range).value;
      };
      scene_.units = Units::of(value(*length), value(*stiffness));
      return;
    }
    for (const Entry& entry : document_.entries) {
      const Key& key = *find_key(entry.key);
      physical_ = is_written_with_unit(entry, key, meaning(key).dimension) || physical_;
    }
    check_all_have_units();
    if (physical_) scene_.units = Units::of(unit_of_length(), bending_stiffness());
  }

  double unit_of_length() const {
    if (scene_.has_cylinder) return in_si("rod.radius") + in_si("cylinder.radius");
    return in_si("rod.length");
  }

  double bending_stiffness() const {
    const Entry* modulus = document_.find("rod.youngs_modulus");
    if (document_.find("rod.bending_stiffness")) {
      if (modulus) throw SceneError(modulus->prefix() + "must not be given beside rod.bending_stiffness");
      return in_si("rod.bending_stiffness");
    }
    if (!modulus)
      throw missing(document_, "rod.bending_stiffness", "a physical scene needs it, or rod.youngs_modulus");
    const double radius = in_si("rod.radius");
    if (radius <= 0.0)
      throw SceneError(document_.find("rod.radius")->prefix() + "must be > 0 with rod.youngs_modulus");
    return in_si("rod.youngs_modulus") * std::numbers::pi * std::pow(radius, 4) / 4.0;
  }

  void fill(const Entry& entry) {
    const Key& key = *find_key(entry.key);
    if (key.kind == ValueKind::text) {
      key.set_text(scene_, read_text(entry, key));
      return;
    }
    if (key.kind == ValueKind::truth) {
      key.set(scene_, read_truth(entry, key) ? 1.0 : 0.0);
      return;
    }
    const Key& like = meaning(key);
    const Number number = read_number(entry, key, like.dimension, like.range);
    const double scale = number.has_unit ? scale_of(*scene_.units, like.dimension) : 1.0;
    const double value = number.value / scale;
    check_size(entry, like, value);
    if (key.set) key.set(scene_, value);
  }

  /// What follows from other keys.
  void derive() {
    if (scene_.second_plate && !document_.find("plate.2.side"))
      scene_.second_plate->side =
          scene_.plate->side == PlateSide::above ? PlateSide::below : PlateSide::above;
    if (!document_.find("rod.bending_stiffness_2"))
      scene_.rod.bending_stiffness_2 = scene_.rod.bending_stiffness;
    if (const Entry* entry = document_.find("rod.poisson_ratio")) {
      if (document_.find("rod.twist_ratio"))
        throw SceneError(entry->prefix() + "must not be given beside rod.twist_ratio");
      const Key& key = *find_key(entry->key);
      scene_.rod.twist_ratio = 1.0 / (1.0 + read_number(*entry, key, key.dimension, key.range).value);
    }
    // A rod that has a radius touches itself where it comes to; where that cannot be honoured only if it is asked for.
    const bool thin_model =
        scene_.model.kind == ModelKind::planar || scene_.model.kind == ModelKind::closed_form;
    if (!document_.find("rod.self_contact"))
      scene_.self_contact = scene_.rod_radius > 0.0 && !scene_.rod.infinite() && !thin_model;
    const bool stiffness_given =
        document_.find("rod.axial_stiffness") || document_.find("rod.axial_compliance");
    if (scene_.rod.extensible && !stiffness_given && scene_.rod_radius > 0.0)
      scene_.rod.axial_stiffness =
          4.0 * scene_.rod.bending_stiffness / (scene_.rod_radius * scene_.rod_radius);
    if (!scene_.continuation) return;
    if (!document_.find("continuation.from"))
      scene_.continuation->from = get_parameter(scene_, scene_.continuation->parameter);
    else if (!document_.find(scene_.continuation->parameter))  // then the branch says where the scene starts
      set_parameter(scene_, scene_.continuation->parameter, scene_.continuation->from);
  }

  const Document& document_;
  const ReadOptions& options_;
  Scene scene_;
  bool physical_ = false;  ///< some entry has a unit
};

}  // namespace

namespace {

bool of_the_file(const Entry& entry) { return entry.place != "--set"; }

/// Where --set names another parameter than the file, the file's first and last value are of the other one.
void drop_values_of_another_parameter(Document& document) {
  const Entry* parameter = document.find("continuation.parameter");
  if (!parameter || of_the_file(*parameter)) return;
  const auto old = document.replaced.find(parameter->key);
  const std::string before = old == document.replaced.end() || !std::get_if<std::string>(&old->second.value)
                                 ? Continuation{}.parameter
                                 : std::get<std::string>(old->second.value);
  if (const auto* now = std::get_if<std::string>(&parameter->value); now && *now == before) return;
  std::erase_if(document.entries, [](const Entry& entry) {
    return of_the_file(entry) && (entry.key == "continuation.from" || entry.key == "continuation.to");
  });
}

}  // namespace

namespace {

/// rod.weight = [x, y, z] as its three components, of which one that is given by itself has its own.
void split_weight(Document& document) {
  const auto found = std::find_if(document.entries.begin(), document.entries.end(),
                                  [](const Entry& entry) { return entry.key == "rod.weight"; });
  if (found == document.entries.end()) return;
  const Entry weight = *found;
  document.entries.erase(found);
  if (weight.elements.size() != 3)
    throw SceneError(weight.prefix() + "must be three forces per length, such as [0.0, -0.1, 0.0]");
  for (std::size_t k = 0; k < 3; ++k) {
    Entry component = weight.elements[k];
    component.key = std::string("rod.weight_") + "xyz"[k];
    const Entry* own = document.find(component.key);
    if (own && (!of_the_file(*own) || of_the_file(weight))) continue;
    std::erase_if(document.entries, [&](const Entry& entry) { return entry.key == component.key; });
    document.entries.push_back(component);
  }
}

}  // namespace

Scene read_scene(const std::filesystem::path& path, std::span<const std::string> overrides,
                 const ReadOptions& options) {
  Document document = read_document(path, overrides);
  split_weight(document);
  drop_values_of_another_parameter(document);
  if (options.restart)
    std::erase_if(document.entries,
                  [](const Entry& entry) { return of_the_file(entry) && entry.key == "continuation.from"; });
  // A file that the scene names lies beside it.
  for (Entry& entry : document.entries)
    if (auto* text = std::get_if<std::string>(&entry.value);
        text && entry.key == "knot.curve" && of_the_file(entry))
      *text = std::filesystem::absolute(path.parent_path() / *text).string();
  return Resolver(document, options).resolve(path.stem().string());
}

}  // namespace windlass::scene
