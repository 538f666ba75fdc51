;;; fathom-mode.el --- scenes of Fathom  -*- lexical-binding: t -*-

;; Version: 0.1.0
;; Package-Requires: ((emacs "28.1"))

;;; Commentary:
;; Colours, indentation and `M-x compile' for texts of Fathom, and its language server by eglot.
;; With eglot, `M-x fathom-show' opens a window of the viewer that follows the buffer as it is typed:
;; point outlines the shape that it stands in, and a click there puts point at its line.
;;
;;   (add-to-list 'load-path "…/editors/emacs")
;;   (require 'fathom-mode)
;;   (add-hook 'fathom-mode-hook #'eglot-ensure)

;;; Code:
(require 'cl-lib)
(require 'compile)
(require 'subr-x)
(require 'fathom-words)

(defgroup fathom nil "Scenes of signed distance functions." :group 'languages)

(defcustom fathom-indent 2 "Blanks of a step of indentation." :type 'integer)
(defcustom fathom-program "fathom" "The program `fathom', or its path." :type 'string)

(defvar fathom-mode-syntax-table
  (let ((table (make-syntax-table)))
    (modify-syntax-entry ?/ ". 124b" table)
    (modify-syntax-entry ?* ". 23" table)
    (modify-syntax-entry ?\n "> b" table)
    (modify-syntax-entry ?_ "w" table)
    (modify-syntax-entry ?\" "\"" table)
    (dolist (sign '(?+ ?- ?% ?^ ?= ?< ?> ?| ?& ?# ?.)) (modify-syntax-entry sign "." table))
    table))

(defvar fathom-font-lock-keywords
  (let ((words (lambda (list) (regexp-opt list 'words))))
    `(("#\\(?:[0-9a-fA-F]\\{8\\}\\|[0-9a-fA-F]\\{6\\}\\|[0-9a-fA-F]\\{3\\}\\)\\_>"
       . font-lock-constant-face)
      (,(concat "\\_<\\(?:[0-9]+\\(?:\\.[0-9]+\\)?\\|\\.[0-9]+\\)\\(?:[eE][+-]?[0-9]+\\)?\\(?:"
                (regexp-opt fathom-units) "\\)?\\_>")
       . 'font-lock-constant-face)
      ("\\_<fn[ \t]+\\([A-Za-z_][A-Za-z0-9_]*\\)" 1 font-lock-function-name-face)
      ("\"[ \t]+\\(as\\)\\_>" 1 font-lock-keyword-face)
      ("\\_<\\(limit\\)[ \t]+[A-Za-z0-9_(]" 1 font-lock-keyword-face)
      (,(funcall words fathom-control) . font-lock-keyword-face)
      (,(funcall words fathom-declaring) . font-lock-keyword-face)
      (,(funcall words fathom-truths) . font-lock-keyword-face)
      (,(concat "\\(?::\\|->\\)[ \t]*\\[*" (regexp-opt fathom-types t) "\\_>") 1
       font-lock-type-face)
      ("\\_<\\([A-Za-z_][A-Za-z0-9_]*\\)[ \t]*:" 1 font-lock-variable-name-face)
      (,(concat (funcall words fathom-functions) "[ \t]*[({]") 1 font-lock-builtin-face)
      (,(funcall words fathom-constants) . font-lock-constant-face)
      (,(funcall words fathom-colors) . font-lock-constant-face))))

(defun fathom-indent-line ()
  "Indent by the brackets around the line, and once more where it goes on a statement."
  (interactive)
  (let* ((state (save-excursion (syntax-ppss (line-beginning-position))))
         (open (nth 1 state))
         (base (if open (save-excursion (goto-char open) (current-indentation)) (- fathom-indent)))
         (text (save-excursion (back-to-indentation) (char-after)))
         (goes-on (memq text '(?. ?| ?&)))
         (wanted (cond ((nth 3 state) (current-indentation))
                       ((memq text '(?\) ?\] ?\})) (max base 0))
                       (goes-on (+ base (* 2 fathom-indent)))
                       (t (+ base fathom-indent)))))
    (if (<= (current-column) (current-indentation))
        (indent-line-to (max wanted 0))
      (save-excursion (indent-line-to (max wanted 0))))))

(add-to-list 'compilation-error-regexp-alist-alist
             '(fathom "^\\(.+?\\):\\([0-9]+\\):\\([0-9]+\\): \\(?:error\\|\\(warning\\)\\|\\(note\\)\\)\\["
                      1 2 3 (4 . 5)))
(add-to-list 'compilation-error-regexp-alist 'fathom)

;;;###autoload
(define-derived-mode fathom-mode prog-mode "Fathom"
  "Scenes of Fathom: texts that declare signed distance functions."
  (setq-local comment-start "// " comment-end "" comment-start-skip "//+[ \t]*")
  (setq-local font-lock-defaults '(fathom-font-lock-keywords))
  (setq-local indent-line-function #'fathom-indent-line indent-tabs-mode nil)
  (when buffer-file-name
    (setq-local compile-command
                (concat fathom-program " check "
                        (shell-quote-argument (file-name-nondirectory buffer-file-name))))))

;;;###autoload
(add-to-list 'auto-mode-alist '("\\.sdf\\'" . fathom-mode))

(declare-function eglot-current-server "eglot")
(declare-function eglot-execute-command "eglot")
(declare-function eglot--TextDocumentIdentifier "eglot")
(declare-function eglot--TextDocumentPositionParams "eglot")
(declare-function eglot--uri-to-path "eglot")
(declare-function eglot--lsp-position-to-point "eglot")
(declare-function jsonrpc-notify "jsonrpc")

(defun fathom--tell-point ()
  "Tell the server where point is, for its window."
  (when-let ((server (eglot-current-server)))
    (jsonrpc-notify server :fathom/cursor (eglot--TextDocumentPositionParams))))

(defun fathom-show ()
  "Open a window of the viewer on this buffer, and tell it where point is from now on."
  (interactive)
  (eglot-execute-command (eglot-current-server) 'fathom.show
                         (vector (plist-get (eglot--TextDocumentIdentifier) :uri)))
  (add-hook 'post-command-hook #'fathom--tell-point nil t))

(with-eval-after-load 'eglot
  (cl-defmethod eglot-handle-notification
    (_server (_method (eql fathom/clicked)) &key uri position)
    "Put point at the place that was clicked in the viewer."
    (pop-to-buffer (find-file-noselect (eglot--uri-to-path uri)))
    (goto-char (eglot--lsp-position-to-point position)))
  (add-to-list 'eglot-server-programs
               `(fathom-mode . ,(lambda (&rest _) (list fathom-program "lsp")))))

(provide 'fathom-mode)
;;; fathom-mode.el ends here
