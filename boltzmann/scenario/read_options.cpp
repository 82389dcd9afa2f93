// One function per kind of member.
#include <boltzmann/scenario/read_options.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace boltzmann {
namespace {

class OptionReader {
 public:
  OptionReader(Section& section, Option const& option, Dimension dimension, OptionMeaning const& meaning)
      : section_(section), option_(option), kind_(option.kind), dimension_(dimension), meaning_(meaning) {}

  void operator()(bool* truth) const { *truth = section_.boolean(option_.key, *truth); }
  void operator()(int* number) const { whole(number); }
  void operator()(std::size_t* number) const { whole(number); }
  void operator()(std::optional<int>* number) const {
    int read = 0;
    if (whole(&read)) *number = read;
  }
  void operator()(std::int64_t* number) const { whole(number); }
  void operator()(double* number) const {
    if (auto const read = quantity()) *number = *read;
  }
  void operator()(std::optional<double>* number) const {
    if (auto const read = quantity()) *number = read;
  }
  void operator()(OptionGroup const& group) const {
    Item const* item = section_.find(option_.key);
    if (!item) return;
    if (!item->is(Item::Kind::table))
      return mistake(
          *item, fmt::format("a table is needed, {} = {}, not {}", option_.key, kind_.words.front(), describe(*item)));
    Section part(*item, option_.key, section_.context());
    read_options(part, *group.options, group.make(), meaning_);
    part.finish();
  }
  void operator()(std::monostate) const { section_.allow(option_.key); }
  void operator()(std::string* text) const {
    using Form = OptionKind::Form;
    Item const* item = section_.find(option_.key);
    if (!item) return;
    auto& context = section_.context();
    auto const read = kind_.form == Form::word ? read_word(*item, option_.key, kind_.words, context)
                      : kind_.form == Form::axis
                          ? read_word(*item, option_.key, axis_names(meaning_.dimension), context)
                      : kind_.form == Form::path ? read_path(*item, option_.key, context)
                                                 : read_text(*item, option_.key, context);
    if (read) *text = *read;
  }
  void operator()(NamedValue const& value) const {
    if (auto const read = section_.word(option_.key, kind_.words)) value.choose(*read);
  }
  void operator()(std::vector<int>* list) const {
    Item const* item = section_.find(option_.key);
    if (!item) return;
    list->clear();
    std::vector<Item> const one{*item};
    for (Item const& element : item->is(Item::Kind::array) ? item->elements : one)
      if (auto const read = read_integer(element, option_.key, low(), high(), section_.context()))
        list->push_back(static_cast<int>(*read));
  }
  void operator()(std::optional<std::array<double, 3>>* vector) const {
    if (meaning_.dimension == 0) return section_.allow(option_.key);
    if (auto const read = section_.vector(option_.key, meaning_.dimension, dimension_)) {
      vector->emplace();
      std::copy(read->begin(), read->end(), (*vector)->begin());
    }
  }
  void operator()(std::span<double> components) const {
    auto const dimension = static_cast<std::size_t>(meaning_.dimension);
    if (dimension == 0 || dimension > components.size()) return section_.allow(option_.key);
    if (auto const read = section_.vector(option_.key, meaning_.dimension, dimension_))
      std::copy(read->begin(), read->end(), components.begin());
  }
  void operator()(std::vector<std::size_t>* by_axis) const {
    Item const* item = section_.find(option_.key);
    if (!item) return;
    bool const list = item->is(Item::Kind::array);
    auto const axes = static_cast<std::size_t>(meaning_.dimension);
    if (list && axes > 0 && item->elements.size() != axes)
      return mistake(*item,
                     fmt::format("{} number{} for {} ax{}; give one for all, or one for each", item->elements.size(),
                                 item->elements.size() == 1 ? "" : "s", axes, axes == 1 ? "is" : "es"));
    std::vector<Item> const one{*item};
    std::vector<std::size_t> all;
    for (Item const& element : list ? item->elements : one)
      if (auto const read = read_integer(element, option_.key, low(), high(), section_.context()))
        all.push_back(static_cast<std::size_t>(*read));
    if (all.size() != (list ? item->elements.size() : 1)) return;
    *by_axis = list ? all : std::vector<std::size_t>(std::max<std::size_t>(axes, 1), all.front());
  }
  void operator()(std::vector<std::uint32_t>*) const { section_.allow(option_.key); }
  void operator()(std::vector<std::string>* list) const {
    if (Item const* item = section_.find(option_.key)) *list = read_texts(*item, option_.key, section_.context());
  }
  void operator()(std::vector<double>* list) const {
    if (Item const* item = section_.find(option_.key)) numbers(*item, *list);
  }
  void operator()(std::vector<std::array<double, 2>>* pairs) const {
    Item const* item = section_.find(option_.key);
    if (!item) return;
    if (!item->is(Item::Kind::array))
      return mistake(*item, fmt::format("pairs are needed, [[low, high], ...], not {}", describe(*item)));
    pairs->clear();
    for (auto const& element : item->elements)
      if (auto const pair = read_vector(element, option_.key, 2, dimension_, section_.context()))
        pairs->push_back({(*pair)[0], (*pair)[1]});
  }
  void operator()(CountOrList const& either) const {
    Item const* item = section_.find(option_.key);
    if (!item) return;
    if (item->is(Item::Kind::array)) {
      if (item->elements.empty()) mistake(*item, "an array without any; leave it out, or give some");
      numbers(*item, *either.list);
      for (std::size_t k = 1; k < either.list->size(); ++k)
        if ((*either.list)[k] <= (*either.list)[k - 1])
          mistake(item->elements[k],
                  fmt::format("{} must be above {}, the one before", (*either.list)[k], (*either.list)[k - 1]));
      return;
    }
    if (auto const read = read_integer(*item, option_.key, low(), high(), section_.context()))
      *either.count = static_cast<int>(*read), either.list->clear();
  }
  void operator()(OptionList const& list) const {
    Item const* item = section_.find(option_.key);
    if (!item) return;
    list.clear();
    std::vector<Item> const one{*item};
    for (Item const& element : item->is(Item::Kind::array) ? item->elements : one) {
      if (!element.is(Item::Kind::table)) {
        mistake(element,
                fmt::format("a table is needed, {{ {} = 1 }}, not {}", list.options->begin()->key, describe(element)));
        continue;
      }
      Section part(element, option_.key, section_.context());
      read_options(part, *list.options, list.add(), meaning_);
      if (element.entries.empty())
        mistake(element, fmt::format("it is empty; it may have {}", join(list.options->keys())));
      part.finish();
    }
  }

 private:
  template <class Whole>
  bool whole(Whole* number) const {
    auto const read = section_.integer(option_.key, low(), high());
    if (read) *number = static_cast<Whole>(*read);
    return read.has_value();
  }
  std::optional<double> quantity() const {
    Item const* item = section_.find(option_.key);
    if (!item) return std::nullopt;
    auto const read = read_quantity(*item, option_.key, dimension_, section_.context(), kind_.range);
    return read && item->is(Item::Kind::text) ? std::optional(*read / kind_.counted_in) : read;
  }
  void numbers(Item const& item, std::vector<double>& list) const {
    if (!item.is(Item::Kind::array))
      return mistake(item, fmt::format("a list of numbers is needed, [1, 2], not {}", describe(item)));
    list.clear();
    for (auto const& element : item.elements)
      if (auto const read = read_quantity(element, option_.key, dimension_, section_.context())) list.push_back(*read);
  }
  std::int64_t low() const { return static_cast<std::int64_t>(kind_.range.low); }
  std::int64_t high() const {
    return std::isinf(kind_.range.high) ? std::numeric_limits<std::int64_t>::max()
                                        : static_cast<std::int64_t>(kind_.range.high);
  }
  void mistake(Item const& item, std::string const& what) const {
    section_.mistake(item.place, about(option_.key, what));
  }

  Section& section_;
  Option const& option_;
  OptionKind const& kind_;
  Dimension dimension_;
  OptionMeaning const& meaning_;
};

/// Nothing if it is unknown.
std::optional<Dimension> dimension_in(int space, OptionKind const& kind) {
  if (kind.by_space == 0) return kind.dimension;
  return space > 0 ? std::optional(*kind.dimension * pow(dimensions::length, kind.by_space * space)) : std::nullopt;
}

/// The object has its default values.
void explain_options(Section& section, OptionTable const& options, void* object, int space) {
  if (!section.explained()) return;
  for (Option option : options) {
    bool const in_words = !option.otherwise.empty() || !option.needed.empty();
    std::string const value = in_words ? "" : toml_value(option, object);
    if (option.kind.form == OptionKind::Form::axis) option.kind = option::word(axis_names(space));
    section.explain(option, value, dimension_in(space, option.kind));
  }
}

}  // namespace

void read_options(Section& section, OptionTable const& options, void* object, OptionMeaning const& meaning) {
  using Form = OptionKind::Form;
  explain_options(section, options, object, meaning.dimension);
  auto const read = [&](Option const& option, Dimension dimension) {
    auto const place = option.place(object);
    bool const of_scenario =
        !option.read_by_code && (option.kind.form == Form::ensembles || option.kind.form == Form::particles);
    // An example with a unit is useless in a scenario without units.
    bool const plain =
        option.needed.starts_with('"') && option.kind.form == Form::number && section.context().units.is_reduced();
    if (!option.needed.empty() && !section.need(option.key, option.key + " = " + (plain ? "1" : option.needed))) return;
    if (of_scenario && meaning.of_scenario)
      meaning.of_scenario(option, place);
    else
      std::visit(OptionReader(section, option, dimension, meaning), place);
  };
  for (auto const& option : options) {
    if (!option.kind.dimension) continue;
    if (auto const dimension = dimension_in(meaning.dimension, option.kind))
      read(option, *dimension);
    else
      section.allow(option.key);
  }
  std::optional<Dimension> shown;
  for (auto const& option : options) {
    if (option.kind.dimension) continue;
    if (section.has(option.key) && !shown && meaning.shown) shown = meaning.shown();
    if (shown)
      read(option, *shown);
    else
      section.allow(option.key);
  }
}

}  // namespace boltzmann
