#include "catena/scene/numbers/number_value.hpp"

namespace catena {

Parsed<std::uint32_t> ExpressionPool::add(std::string_view text, const ExpressionScope& scope) {
  std::string key;
  for (const std::string& variable : scope.loop_variables) key += variable + '\n';
  key += text;
  if (const auto known = index_.find(key); known != index_.end()) return known->second;
  Parsed<Expression> parsed = Expression::parse(text, scope);
  if (!parsed) return parsed.error;
  const auto number = static_cast<std::uint32_t>(expressions_.size());
  expressions_.push_back(std::move(*parsed));
  index_.emplace(std::move(key), number);
  return number;
}

}  // namespace catena
