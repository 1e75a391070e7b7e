namespace raymoval {}
