;;; marks.el --- what the mode makes of each character (grammars.py)  -*- lexical-binding: t -*-
(require 'fathom-mode)

(defun marks-class (face)
  (cond ((memq face '(font-lock-comment-face font-lock-comment-delimiter-face font-lock-doc-face)) ?c)
        ((eq face 'font-lock-string-face) ?s)
        ((eq face 'font-lock-keyword-face) ?k)
        (t ?.)))

(dolist (file command-line-args-left)
  (with-temp-buffer
    (insert-file-contents file)
    (fathom-mode)
    (font-lock-ensure)
    (let ((marks (make-string (buffer-size) ?.)))
      (dotimes (i (buffer-size))
        (let ((face (get-text-property (1+ i) 'face)))
          (aset marks i (marks-class (if (consp face) (car face) face)))))
      (write-region marks nil (concat file ".marks") nil 'silent))))
(setq command-line-args-left nil)
