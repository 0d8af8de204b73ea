// What the grammar of tree-sitter cannot say: that a suffix stays on the line of its value, and that a line which begins
// with the word of an item begins an item, however the one before it was left.

#include "tree_sitter/parser.h"
#include <string.h>

enum TokenType { SUFFIX, PRIME, MISSING, RECOVERING };

static const char *const ITEMS[] = {
  // words: items
"model", "param", "const", "let", "fn", "data", "free", "time", "state", "control", "surface", "dynamics", "metric", "jump", "start", "end", "path", "minimize", "maximize", "guess", "phase", "link", "method", "sweep", "report", "expect"
};

void *tree_sitter_fdc_external_scanner_create(void) { return NULL; }
void tree_sitter_fdc_external_scanner_destroy(void *payload) {}
unsigned tree_sitter_fdc_external_scanner_serialize(void *payload, char *buffer) { return 0; }
void tree_sitter_fdc_external_scanner_deserialize(void *payload, const char *buffer, unsigned length) {}

static void skip_blanks(TSLexer *lexer) {
  while (lexer->lookahead == ' ' || lexer->lookahead == '\t') lexer->advance(lexer, true);
}

static bool is_blank(int32_t character) {
  return character == ' ' || character == '\t' || character == '\r' || character == '\n';
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

// In front of `'`, or of `(`, `.` and `[2]`.
static bool scan_suffix(TSLexer *lexer, const bool *valid_symbols) {
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

// Goes on to the first word behind blanks and comments; whether that was on another line.
static bool next_line(TSLexer *lexer) {
  bool is_new = false;
  for (;; lexer->advance(lexer, false)) {
    if (lexer->lookahead == '#') {
      while (!lexer->eof(lexer) && lexer->lookahead != '\n') lexer->advance(lexer, false);
    }
    is_new |= lexer->lookahead == '\n';
    if (lexer->eof(lexer) || !is_blank(lexer->lookahead)) return is_new;
  }
}

static bool is_item_word(TSLexer *lexer) {
  char word[16] = "";
  for (size_t length = 0; length + 1 < sizeof word && 'a' <= lexer->lookahead && lexer->lookahead <= 'z'; length++) {
    word[length] = (char)lexer->lookahead;
    lexer->advance(lexer, false);
  }
  // `end_1` and `endμ` are names.
  if (lexer->lookahead == '_' || lexer->lookahead > 127 || is_digit(lexer->lookahead)) return false;
  for (size_t at = 0; at < sizeof ITEMS / sizeof *ITEMS; at++) {
    if (strcmp(word, ITEMS[at]) == 0) return true;
  }
  return false;
}

// In place of a value that has not been written yet, on the last line of an item.
static bool scan_missing(TSLexer *lexer) {
  lexer->mark_end(lexer);
  lexer->result_symbol = MISSING;
  return next_line(lexer) && is_item_word(lexer);
}

// Tokens without width.
bool tree_sitter_fdc_external_scanner_scan(void *payload, TSLexer *lexer, const bool *valid_symbols) {
  // While the parser recovers from a mistake it asks for every token; one without width would not help it on.
  if (valid_symbols[RECOVERING]) return false;
  if (valid_symbols[SUFFIX] || valid_symbols[PRIME]) return scan_suffix(lexer, valid_symbols);
  return valid_symbols[MISSING] && scan_missing(lexer);
}
