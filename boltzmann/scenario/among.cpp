// Expands one table with `among` to a table for each pair of species.
#include <boltzmann/scenario/among.hpp>

#include <boltzmann/core/error.hpp>
#include <boltzmann/core/quantity_text.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>

namespace boltzmann {
namespace {

class Among {
 public:
  Among(Item const& table, Reading& reading) : table_(table), reading_(reading) {}

  std::vector<Item> tables() {
    std::size_t const before = reading_.context.mistakes.count();
    read_names();
    for (char const* key : {"on", "by", "between", "connect", "from_outside"})
      if (Entry const* entry = table_.find(key))
        mistake(entry->place, fmt::format("{}: 'among' already chooses the ensembles; leave one out", key));
    read_mixing();
    if (reading_.context.mistakes.count() != before) return {};
    std::vector<Item> tables;
    for (auto const& name : names_) tables.push_back(table_for(name, name));
    for (std::size_t i = 0; i < names_.size(); ++i)
      for (std::size_t k = i + 1; k < names_.size(); ++k) tables.push_back(table_for(names_[i], names_[k]));
    for (auto const& [parameter, rule] : mixing_)
      if (std::find(tables_by_names_.begin(), tables_by_names_.end(), parameter) == tables_by_names_.end())
        mistake(rule->place, fmt::format("mixing.{}: there is no parameter {} that is a table by names{}", parameter,
                                         parameter, did_you_mean(parameter, tables_by_names_)));
    return reading_.context.mistakes.count() == before ? std::move(tables) : std::vector<Item>{};
  }

 private:
  void mistake(Place const& place, std::string what) { reading_.mistake(place, std::move(what)); }

  void read_names() {
    Entry const* among = table_.find("among");
    if (!among->item.is(Item::Kind::array) || among->item.elements.empty())
      return mistake(among->item.place, fmt::format("among: the names of ensembles are needed, [\"argon\", "
                                                    "\"krypton\"], not {}",
                                                    describe(among->item)));
    for (auto const& word : among->item.elements) {
      if (!reading_.ensemble(word, "among")) continue;
      if (std::find(names_.begin(), names_.end(), word.text) != names_.end())
        mistake(word.place, fmt::format("among: '{}' twice", word.text));
      names_.push_back(word.text);
    }
  }

  void read_mixing() {
    Entry const* mixing = table_.find("mixing");
    if (!mixing) return;
    if (!mixing->item.is(Item::Kind::table))
      return mistake(mixing->item.place, fmt::format("mixing: a table is needed, {{ depth = \"geometric\" }}, not {}",
                                                     describe(mixing->item)));
    for (auto const& entry : mixing->item.entries)
      if (read_word(entry.item, "mixing." + entry.key, std::vector<std::string>{"arithmetic", "geometric"},
                    reading_.context))
        mixing_.emplace_back(entry.key, &entry.item);
  }

  /// The same table with a single number for each parameter.
  Item table_for(std::string const& a, std::string const& b) {
    Item table = table_;
    std::erase_if(table.entries, [](Entry const& entry) { return entry.key == "among" || entry.key == "mixing"; });
    for (auto& entry : table.entries) {
      if (entry.key == "parameters" && entry.item.is(Item::Kind::table))
        for (auto& parameter : entry.item.entries) choose(parameter, a, b);
      else if (entry.key != "where")
        choose(entry, a, b);
    }
    Place const place = table_.find("among")->item.place;
    if (a == b) {
      table.entries.push_back({"on", place, Item::of_text(a, place)});
    } else {
      Item both;
      both.kind = Item::Kind::array;
      both.place = place;
      both.elements = {Item::of_text(a, place), Item::of_text(b, place)};
      table.entries.push_back({"between", place, std::move(both)});
    }
    return table;
  }

  void choose(Entry& parameter, std::string const& a, std::string const& b) {
    if (!parameter.item.is(Item::Kind::table)) return;
    Item const by_names = parameter.item;
    if (std::find(tables_by_names_.begin(), tables_by_names_.end(), parameter.key) == tables_by_names_.end()) {
      tables_by_names_.push_back(parameter.key);
      check_names(parameter.key, by_names);
    }
    auto const value = [&](std::string const& key) {
      Entry const* entry = by_names.find(key);
      return entry ? &entry->item : nullptr;
    };
    Item const* chosen = a == b ? value(a) : value(a + "-" + b);
    if (!chosen && a != b) chosen = value(b + "-" + a);
    if (chosen) {
      parameter.item = *chosen;
      return;
    }
    auto const rule =
        std::find_if(mixing_.begin(), mixing_.end(), [&](auto const& m) { return m.first == parameter.key; });
    if (a == b)
      mistake(by_names.place, fmt::format("{}: it has none for '{}'", parameter.key, a));
    else if (rule == mixing_.end())
      mistake(by_names.place, fmt::format("{}: it has none for \"{}-{}\"; add it, or mixing = {{ {} = \"geometric\" }}",
                                          parameter.key, a, b, parameter.key));
    else if (value(a) && value(b))
      parameter.item = mixed(parameter.key, *value(a), *value(b), rule->second->text == "geometric");
  }

  /// Checks that every key of such a table is a species or a pair of species.
  void check_names(std::string const& parameter, Item const& by_names) {
    std::vector<std::string> allowed = names_;
    for (std::size_t i = 0; i < names_.size(); ++i)
      for (std::size_t k = i + 1; k < names_.size(); ++k) allowed.push_back(names_[i] + "-" + names_[k]);
    for (auto const& entry : by_names.entries) {
      bool known = std::find(allowed.begin(), allowed.end(), entry.key) != allowed.end();
      for (auto const& a : names_)
        for (auto const& b : names_) known = known || (a != b && entry.key == b + "-" + a);
      if (!known)
        mistake(entry.place, fmt::format("{}: '{}' is no ensemble, nor two of them with a - between{}", parameter,
                                         entry.key, choices_with(did_you_mean(entry.key, allowed), names_)));
    }
  }

  /// (x + y)/2, or the square root of x y, in the unit of x.
  Item mixed(std::string const& parameter, Item const& x, Item const& y, bool geometric) {
    auto const first = number_of(parameter, x), second = number_of(parameter, y);
    if (!first || !second) return x;
    if (first->unit.empty() != second->unit.empty() || !(first->dimension == second->dimension)) {
      mistake(y.place, fmt::format("{}: {} and {} can't be mixed", parameter, describe(x), describe(y)));
      return x;
    }
    double const a = first->number, b = second->number * (second->one / first->one);
    if (geometric && !(a * b >= 0)) {
      mistake(y.place, fmt::format("{}: {} and {} have no geometric mean: their signs differ", parameter, describe(x),
                                   describe(y)));
      return x;
    }
    double const mean = geometric ? std::copysign(std::sqrt(a) * std::sqrt(b), a) : 0.5 * (a + b);
    Item result = first->unit.empty() ? Item::of_number(mean, x.place)
                                      : Item::of_text(fmt::format("{} {}", mean, first->unit), x.place);
    result.written = x.written;
    return result;
  }

  struct Number {
    double number;
    std::string unit;  ///< empty: none
    double one = 1;    ///< value of this unit in SI
    Dimension dimension = dimensions::none;
  };
  std::optional<Number> number_of(std::string const& parameter, Item const& item) {
    if (item.is_number()) return Number{item.number, ""};
    std::optional<Number> result;
    if (item.is(Item::Kind::text)) {
      catch_errors(reading_, item.place, [&] {
        TextQuantity const quantity = parse_quantity(item.text);
        char* end = nullptr;
        double const number = std::strtod(item.text.c_str(), &end);
        std::string unit = end;
        unit.erase(0, unit.find_first_not_of(' '));
        if (quantity.has_unit && end != item.text.c_str())
          result = Number{number, unit, parse_quantity("1 " + unit).si, quantity.dimension};
        else
          result = Number{quantity.si, ""};
      });
    } else {
      mistake(item.place, fmt::format("{}: a quantity is needed to be mixed, not {}", parameter, describe(item)));
    }
    return result;
  }

  Item const& table_;
  Reading& reading_;
  std::vector<std::string> names_, tables_by_names_;
  std::vector<std::pair<std::string, Item const*>> mixing_;
};

}  // namespace

std::vector<Item> influences_among(Item const& table, Reading& reading) { return Among(table, reading).tables(); }

}  // namespace boltzmann
