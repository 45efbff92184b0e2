#include "catena/scene/explaining/schema_fixed.hpp"

namespace catena {

std::string_view fixed_definitions() {
  return R"json({
"number": {
  "anyOf": [{"type": "number"}, {"type": "string", "minLength": 1}],
  "description": "a number (SI, radians), a quantity \"120 mm\", an expression \"=2*a\" or a parameter"
},
"pair": {"type": "array", "items": {"$ref": "#/$defs/number"}, "minItems": 2, "maxItems": 2},
"numbers": {"type": "array", "items": {"$ref": "#/$defs/number"}},
"beyond": {"enum": ["error", "hold", "line"], "description": "continuation beyond the ends (default: leaving the table is an error)"},
"table": {"anyOf": [
  {"$ref": "#/$defs/pairsOrFile"},
  {"type": "object", "additionalProperties": false, "anyOf": [{"required": ["points"]}, {"required": ["file"]}],
    "properties": {
    "file": {"$ref": "#/$defs/fileName"}, "columns": {"$ref": "#/$defs/fileColumns"},
    "unit": {"$ref": "#/$defs/fileUnit"}, "smooth": {"$ref": "#/$defs/fileSmooth"},
    "points": {"$ref": "#/$defs/pairsOrFile"}, "beyond": {"$ref": "#/$defs/beyond"}}}
]},
"measure": {"anyOf": [
  {"type": "object", "additionalProperties": false, "minProperties": 1, "maxProperties": 1, "properties": {
    "max": {"type": "string"}, "min": {"type": "string"}, "range": {"type": "string"}, "first": {"type": "string"},
    "final": {"type": "string"}, "mean": {"type": "string"}, "rms": {"type": "string"},
    "integral": {"type": "string"}, "field": {"type": "string"}}},
  {"type": "object", "additionalProperties": false, "required": ["at", "of"], "properties": {
    "at": {"$ref": "#/$defs/number"}, "of": {"type": "string"}}},
  {"type": "object", "additionalProperties": false, "required": ["path", "to"], "properties": {
    "path": {"type": "array", "items": {"type": "string"}, "minItems": 2, "maxItems": 2},
    "to": {"$ref": "#/$defs/pairsOrFile"}, "timed": {"type": "boolean"}}}
], "description": "an extreme, value, mean or integral of a column or expression, a distance from a path, a field"},
"outputs": {"type": "array", "items": {"type": "string"}},
"fileName": {"type": "string", "description": "a CSV file; its path is relative to the scene's folder"},
"fileColumns": {"type": ["array", "integer", "string"], "items": {"type": ["integer", "string"]},
  "description": "numbers from 1, or names in the file's first line; by default the first ones"},
"fileUnit": {"type": ["array", "string"], "items": {"type": "string"},
  "description": "of each column, or of all; by default SI and radians"},
"fileSmooth": {"type": ["number", "string"],
  "description": "root mean square by which values may be moved to be smoother, in the unit of the last column"},
"file": {"type": "object", "additionalProperties": false, "required": ["file"], "properties": {
  "file": {"$ref": "#/$defs/fileName"}, "columns": {"$ref": "#/$defs/fileColumns"},
  "unit": {"$ref": "#/$defs/fileUnit"}, "smooth": {"$ref": "#/$defs/fileSmooth"}}},
"numbersOrFile": {"anyOf": [{"$ref": "#/$defs/numbers"}, {"$ref": "#/$defs/file"}]},
"pairsOrFile": {"anyOf": [
  {"type": "array", "items": {"$ref": "#/$defs/pair"}}, {"$ref": "#/$defs/file"}]},
"parameter": {"anyOf": [
  {"$ref": "#/$defs/number"},
  {"type": "object", "additionalProperties": false, "required": ["value"], "properties": {
    "value": {"$ref": "#/$defs/number"}, "min": {"$ref": "#/$defs/number"}, "max": {"$ref": "#/$defs/number"}}}
]},
"attachment": {
  "anyOf": [
    {"type": "string"},
    {"type": "array", "prefixItems": [{"type": "string"}, {"$ref": "#/$defs/pair"}], "minItems": 2, "maxItems": 2}],
  "description": "\"body\", \"body.point\" or [\"body\", [x', y']]"
},
"function": {"anyOf": [
  {"$ref": "#/$defs/number"},
  {"type": "object", "minProperties": 1, "maxProperties": 1, "additionalProperties": false, "properties": {
    "polynomial": {"allOf": [{"$ref": "#/$defs/numbers"}, {"minItems": 1}]},
    "harmonic": {"type": "object", "additionalProperties": false, "required": ["amplitude", "omega"], "properties": {
      "amplitude": {"$ref": "#/$defs/number"}, "omega": {"$ref": "#/$defs/number"},
      "phase": {"$ref": "#/$defs/number"}, "offset": {"$ref": "#/$defs/number"}}},
    "step": {"type": "object", "additionalProperties": false, "required": ["t0", "t1", "from", "to"], "properties": {
      "t0": {"$ref": "#/$defs/number"}, "t1": {"$ref": "#/$defs/number"},
      "from": {"$ref": "#/$defs/number"}, "to": {"$ref": "#/$defs/number"}, "order": {"enum": [3, 5]}}},
    "law": {"type": "object", "additionalProperties": false, "required": ["type", "t0", "t1", "from", "to"],
      "properties": {
      "type": {"enum": ["cycloidal", "poly345", "poly4567", "modified_trapezoid", "modified_sine"]},
      "t0": {"$ref": "#/$defs/number"}, "t1": {"$ref": "#/$defs/number"},
      "from": {"$ref": "#/$defs/number"}, "to": {"$ref": "#/$defs/number"}}},
    "spline": {"type": "object", "additionalProperties": false, "properties": {
      "t": {"$ref": "#/$defs/numbersOrFile"}, "value": {"$ref": "#/$defs/numbersOrFile"},
      "points": {"$ref": "#/$defs/pairsOrFile"},
      "file": {"$ref": "#/$defs/fileName"}, "columns": {"$ref": "#/$defs/fileColumns"},
      "unit": {"$ref": "#/$defs/fileUnit"}, "smooth": {"$ref": "#/$defs/fileSmooth"},
      "end": {"enum": ["natural", "clamped", "periodic"]}, "beyond": {"$ref": "#/$defs/beyond"}}},
    "sum": {"type": "array", "minItems": 1, "items": {"$ref": "#/$defs/function"}},
    "product": {"type": "array", "minItems": 1, "items": {"$ref": "#/$defs/function"}}}}
]},
"curve": {"type": "object", "minProperties": 1, "maxProperties": 1, "additionalProperties": false, "properties": {
  "circle": {"type": "object", "additionalProperties": false, "required": ["centre", "radius"], "properties": {
    "centre": {"$ref": "#/$defs/pair"}, "radius": {"$ref": "#/$defs/number"}}},
  "spline": {"type": "object", "additionalProperties": false, "anyOf": [{"required": ["points"]}, {"required": ["file"]}],
    "properties": {
    "file": {"$ref": "#/$defs/fileName"}, "columns": {"$ref": "#/$defs/fileColumns"},
    "unit": {"$ref": "#/$defs/fileUnit"}, "smooth": {"$ref": "#/$defs/fileSmooth"},
    "points": {"$ref": "#/$defs/pairsOrFile"}, "end": {"enum": ["natural", "periodic"]},
    "beyond": {"$ref": "#/$defs/beyond"}}},
  "polar": {"type": "object", "additionalProperties": false,
    "anyOf": [{"required": ["angle", "radius"]}, {"required": ["points"]}, {"required": ["file"]}], "properties": {
    "file": {"$ref": "#/$defs/fileName"}, "columns": {"$ref": "#/$defs/fileColumns"},
    "unit": {"$ref": "#/$defs/fileUnit"}, "smooth": {"$ref": "#/$defs/fileSmooth"},
    "points": {"$ref": "#/$defs/pairsOrFile"},
    "angle": {"$ref": "#/$defs/numbersOrFile"}, "radius": {"$ref": "#/$defs/numbersOrFile"}}},
  "line": {"type": "object", "additionalProperties": false, "required": ["point", "axis"], "properties": {
    "point": {"$ref": "#/$defs/pair"}, "axis": {"$ref": "#/$defs/pair"}}}}}
})json";
}

}  // namespace catena
