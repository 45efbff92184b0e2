# Puts style and script into the page, and the page into a source file as an array of bytes.
# HTML STYLE SCRIPT: inputs; PAGE: the page as a file to be looked at; OUTPUT: the source file.
file(READ "${HTML}" html)
file(READ "${STYLE}" style)
file(READ "${SCRIPT}" script)
# Each is put between the pieces around its mark: replaced text is not looked at again.
string(FIND "${html}" "CATENA_STYLE" style_at)
string(FIND "${html}" "CATENA_SCRIPT" script_at)
if(style_at LESS 0 OR script_at LESS style_at)
  message(FATAL_ERROR "${HTML}: wants CATENA_STYLE and, behind it, CATENA_SCRIPT")
endif()
string(SUBSTRING "${html}" 0 ${style_at} head)
math(EXPR behind_style "${style_at} + 12")
math(EXPR between "${script_at} - ${behind_style}")
string(SUBSTRING "${html}" ${behind_style} ${between} middle)
math(EXPR behind_script "${script_at} + 13")
string(SUBSTRING "${html}" ${behind_script} -1 tail)
file(WRITE "${PAGE}" "${head}${style}${middle}${script}${tail}")

file(READ "${PAGE}" bytes HEX)
string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
string(REGEX REPLACE "(0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,)" "\\1\n" bytes
                     "${bytes}")
file(WRITE "${OUTPUT}"
"// Made from apps/viewer.
#include \"catena/scene/viewing/viewer_page.hpp\"

namespace {
constexpr unsigned char page[] = {
${bytes}};
}  // namespace

std::string_view catena::viewer_template() { return {reinterpret_cast<const char*>(page), sizeof page}; }
")
