$# Statements: the camera of the scene's first view.
    fathom_origin = $ORIGIN;
    fathom_right = $RIGHT;
    fathom_up = $UP;
    fathom_forward = $FORWARD;
