// A JSON text as a compact read-only tree with the position of every value.
//
// One array of 16-byte nodes in source order: a container is followed by its descendants and holds the index of the
// node after them, a member is a string node (the key) followed by its value. Nothing is allocated per value; strings
// without escapes stay in the source. Keys keep their order, so reading 10^5 bodies is one walk; find() is linear and
// meant for the dozen keys of a body. Written for scenes of tens of megabytes, where a general JSON tree costs ten
// times the memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "catena/scene/json/diagnostic.hpp"
#include "catena/scene/json/source_text.hpp"

namespace catena {

enum class JsonKind : std::uint8_t { null, boolean, number, string, array, object };

/// "a number", "an object": for messages.
std::string_view describe(JsonKind kind);

struct JsonNode {
  struct Span {
    std::uint32_t begin;   // string: first byte (in the source, or among the decoded ones); container: unused
    std::uint32_t length;  // string: bytes
  };
  struct Children {
    std::uint32_t end;    // index of the node after the last descendant
    std::uint32_t count;  // elements or members
  };
  std::uint32_t offset;  // first byte in the source
  JsonKind kind;
  bool decoded;  // a string with escapes, stored apart
  union {
    double number;
    bool boolean;
    Span string;
    Children children;
  };
};

class JsonDocument;
class JsonElements;
class JsonMembers;

/// A value in a document: two words, copied freely, valid as long as the document stays where it is.
class JsonValue {
 public:
  JsonValue() = default;
  JsonValue(const JsonDocument& document, std::uint32_t index) : document_(&document), index_(index) {}

  /// False for the result of an unsuccessful find(); no other function may be called on such a value.
  explicit operator bool() const { return document_ != nullptr; }

  JsonKind kind() const { return node().kind; }
  bool is(JsonKind kind) const { return node().kind == kind; }
  const SourceText& source() const;
  /// Offset of its first character in the source.
  std::size_t offset() const { return node().offset; }

  double number() const { return node().number; }             ///< of a number: always finite
  bool boolean() const { return node().boolean; }             ///< of true or false
  std::string_view text() const;                              ///< of a string: escapes decoded, valid UTF-8
  std::size_t size() const { return node().children.count; }  ///< of an array or object
  JsonElements elements() const;                              ///< of an array
  JsonMembers members() const;                                ///< of an object
  /// Value of the key, or the absent value: of an object. Linear in the number of members.
  JsonValue find(std::string_view key) const;

 private:
  friend class JsonElements;
  friend class JsonMembers;
  const JsonNode& node() const;
  std::uint32_t after() const;  // index of the next value

  const JsonDocument* document_ = nullptr;
  std::uint32_t index_ = 0;
};

struct JsonMember {
  JsonValue key;  ///< a string
  JsonValue value;

  std::string_view name() const { return key.text(); }
};

/// Range of the values of an array.
class JsonElements {
 public:
  class Iterator {
   public:
    Iterator(const JsonDocument& document, std::uint32_t index) : at_(document, index) {}
    const JsonValue& operator*() const { return at_; }
    const JsonValue* operator->() const { return &at_; }
    Iterator& operator++() {
      at_.index_ = at_.after();
      return *this;
    }
    bool operator==(const Iterator& other) const { return at_.index_ == other.at_.index_; }

   private:
    friend class JsonElements;
    JsonValue at_;
  };

  explicit JsonElements(const JsonValue& array) : array_(array) {}
  Iterator begin() const { return {*array_.document_, array_.index_ + 1}; }
  Iterator end() const { return {*array_.document_, array_.node().children.end}; }

 private:
  JsonValue array_;
};

/// Range of the members of an object, in source order.
class JsonMembers {
 public:
  class Iterator {
   public:
    Iterator(const JsonDocument& document, std::uint32_t index) : document_(&document), index_(index) {}
    JsonMember operator*() const { return {{*document_, index_}, {*document_, index_ + 1}}; }
    Iterator& operator++() {
      index_ = JsonValue(*document_, index_ + 1).after();
      return *this;
    }
    bool operator==(const Iterator& other) const { return index_ == other.index_; }

   private:
    const JsonDocument* document_;
    std::uint32_t index_;
  };

  explicit JsonMembers(const JsonValue& object) : object_(object) {}
  Iterator begin() const { return {*object_.document_, object_.index_ + 1}; }
  Iterator end() const { return {*object_.document_, object_.node().children.end}; }

 private:
  JsonValue object_;
};

class JsonDocument {
 public:
  /// Parses JSON with // and /* */ comments; a byte order mark is tolerated. Reports to `diagnostics` and returns
  /// nothing if the text is not JSON: the first violation of the grammar, nesting deeper than 64, invalid UTF-8. Keys
  /// given twice and numbers too large for a double are reported too, all of them, but leave the document readable, so
  /// that the errors in it can be found as well. `source` must outlive the document and stay where it is.
  static std::optional<JsonDocument> parse(const SourceText& source, Diagnostics& diagnostics);

  JsonValue root() const { return {*this, 0}; }
  const SourceText& source() const { return *source_; }

  const std::vector<JsonNode>& nodes() const { return nodes_; }
  std::string_view string_of(const JsonNode& node) const {
    const std::string_view bytes = node.decoded ? std::string_view(decoded_) : source_->text();
    return bytes.substr(node.string.begin, node.string.length);
  }

 private:
  friend class JsonBuilder;
  explicit JsonDocument(const SourceText& source) : source_(&source) {}

  const SourceText* source_;
  std::vector<JsonNode> nodes_;
  std::string decoded_;  // strings with escapes, one after the other
};

inline const JsonNode& JsonValue::node() const { return document_->nodes()[index_]; }
inline const SourceText& JsonValue::source() const { return document_->source(); }
inline std::string_view JsonValue::text() const { return document_->string_of(node()); }
inline std::uint32_t JsonValue::after() const {
  const JsonNode& n = node();
  return n.kind >= JsonKind::array ? n.children.end : index_ + 1;
}
inline JsonElements JsonValue::elements() const { return JsonElements(*this); }
inline JsonMembers JsonValue::members() const { return JsonMembers(*this); }

}  // namespace catena
