// What the grammar of tree-sitter cannot say: that a suffix stays on the line of its value.

#include "tree_sitter/parser.h"

enum TokenType { SUFFIX, PRIME, RECOVERING };

void *tree_sitter_fdc_external_scanner_create(void) { return NULL; }
void tree_sitter_fdc_external_scanner_destroy(void *payload) {}
unsigned tree_sitter_fdc_external_scanner_serialize(void *payload, char *buffer) { return 0; }
void tree_sitter_fdc_external_scanner_deserialize(void *payload, const char *buffer, unsigned length) {}

static void skip_blanks(TSLexer *lexer) {
  while (lexer->lookahead == ' ' || lexer->lookahead == '\t') lexer->advance(lexer, true);
}

static bool is_digit(int32_t character) { return '0' <= character && character <= '9'; }

// Behind `[`: whether this is an index, `[2]`, and no unit, `[1/s]`.
static bool is_index(TSLexer *lexer) {
  lexer->advance(lexer, false);
  skip_blanks(lexer);
  if (!is_digit(lexer->lookahead)) return false;
  while (is_digit(lexer->lookahead)) lexer->advance(lexer, false);
  skip_blanks(lexer);
  return lexer->lookahead == ']';
}

// Tokens without width, on the line of the value before: one in front of `'`, one in front of `(`, `.` and `[2]`.
bool tree_sitter_fdc_external_scanner_scan(void *payload, TSLexer *lexer, const bool *valid_symbols) {
  // While the parser recovers from a mistake it asks for every token; one without width would not help it on.
  if (valid_symbols[RECOVERING]) return false;
  skip_blanks(lexer);
  lexer->mark_end(lexer);
  lexer->result_symbol = lexer->lookahead == '\'' ? PRIME : SUFFIX;
  if (!valid_symbols[lexer->result_symbol]) return false;
  switch (lexer->lookahead) {
    case '(':
    case '.':
    case '\'':
      return true;
    case '[':
      return is_index(lexer);
    default:
      return false;
  }
}
